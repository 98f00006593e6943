#include "simulation/reference/in_double.h"
// The language layer in double precision has to come before all else.
#include "kernels/energies/tetrahedron.h"
#include "simulation/reference/element_energies.h"

namespace weft {

namespace {

class TetrahedronEnergies final : public ElementEnergies {
public:
    explicit TetrahedronEnergies(const Tetrahedra& tetrahedra) : tetrahedra_(tetrahedra) {}

    int count() const override { return tetrahedra_.elements.count(); }
    std::span<const int> corners(int tetrahedron) const override {
        return tetrahedra_.elements.vertices_of(tetrahedron);
    }

    double energy(int tetrahedron, const Vec3* x) const override {
        return kernels::tetrahedron_energy(deformed(tetrahedron, x));
    }

    void gradient(int tetrahedron, const Vec3* x, Vec3* gradient) const override {
        const kernels::tetrahedron t = deformed(tetrahedron, x);
        for (int j = 0; j < 4; ++j) {
            gradient[j] = to_vec3(kernels::tetrahedron_gradient(t, b(tetrahedron, j)));
        }
    }

    void hessian(int tetrahedron, const Vec3* x, Mat3* blocks) const override {
        const kernels::tetrahedron t = deformed(tetrahedron, x);
        for (int j = 0; j < 4; ++j) {
            for (int k = 0; k < 4; ++k) {
                blocks[4 * j + k] =
                    to_mat3(kernels::tetrahedron_block(t, b(tetrahedron, j), b(tetrahedron, k)));
            }
        }
    }

private:
    kernels::real3 b(int tetrahedron, int corner) const {
        return to_real3(tetrahedra_.shape_gradient(tetrahedron, corner));
    }

    kernels::tetrahedron deformed(int tetrahedron, const Vec3* x) const {
        return kernels::make_tetrahedron(
            kernels::tetrahedron_map(to_real3(x[0]), to_real3(x[1]), to_real3(x[2]), to_real3(x[3]),
                                     b(tetrahedron, 1), b(tetrahedron, 2), b(tetrahedron, 3)),
            tetrahedra_.mu(tetrahedron), tetrahedra_.lambda(tetrahedron));
    }

    const Tetrahedra& tetrahedra_;
};

}  // namespace

std::unique_ptr<ElementEnergies> make_tetrahedron_energies(const Tetrahedra& tetrahedra) {
    return std::make_unique<TetrahedronEnergies>(tetrahedra);
}

}  // namespace weft
