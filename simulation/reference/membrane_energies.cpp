#include "simulation/reference/in_double.h"
// The language layer in double precision has to come before all else.
#include "kernels/energies/membrane.h"
#include "simulation/reference/element_energies.h"

namespace weft {

namespace {

class MembraneEnergies final : public ElementEnergies {
public:
    explicit MembraneEnergies(const Membranes& membranes) : membranes_(membranes) {}

    int count() const override { return membranes_.elements.count(); }
    std::span<const int> corners(int triangle) const override {
        return membranes_.elements.vertices_of(triangle);
    }

    double energy(int triangle, const Vec3* x) const override {
        return kernels::membrane_energy(deformed(triangle, x));
    }

    void gradient(int triangle, const Vec3* x, Vec3* gradient) const override {
        const kernels::membrane m = deformed(triangle, x);
        for (int j = 0; j < 3; ++j) {
            gradient[j] = to_vec3(kernels::membrane_gradient(m, b(triangle, j)));
        }
    }

    void hessian(int triangle, const Vec3* x, Mat3* blocks) const override {
        const kernels::membrane m = deformed(triangle, x);
        for (int j = 0; j < 3; ++j) {
            for (int k = 0; k < 3; ++k) {
                blocks[3 * j + k] =
                    to_mat3(kernels::membrane_block(m, b(triangle, j), b(triangle, k)));
            }
        }
    }

private:
    kernels::real2 b(int triangle, int corner) const {
        const auto [u, v] = membranes_.shape_gradient(triangle, corner);
        return kernels::make2(u, v);
    }

    kernels::membrane deformed(int triangle, const Vec3* x) const {
        return kernels::make_membrane(to_real3(x[0]), to_real3(x[1]), to_real3(x[2]),
                                      b(triangle, 1), b(triangle, 2), membranes_.mu(triangle),
                                      membranes_.lambda(triangle));
    }

    const Membranes& membranes_;
};

}  // namespace

std::unique_ptr<ElementEnergies> make_membrane_energies(const Membranes& membranes) {
    return std::make_unique<MembraneEnergies>(membranes);
}

}  // namespace weft
