#include "simulation/reference/in_double.h"
// The language layer in double precision has to come before all else.
#include "kernels/energies/spring.h"
#include "simulation/reference/element_energies.h"

namespace weft {

namespace {

class SpringEnergies final : public ElementEnergies {
public:
    explicit SpringEnergies(const Springs& springs) : springs_(springs) {}

    int count() const override { return springs_.elements.count(); }
    std::span<const int> corners(int spring) const override {
        return springs_.elements.vertices_of(spring);
    }

    double energy(int spring, const Vec3* x) const override {
        return kernels::spring_energy(to_real3(x[0]), to_real3(x[1]), springs_.rest_length(spring),
                                      springs_.stiffness(spring));
    }

    void gradient(int spring, const Vec3* x, Vec3* gradient) const override {
        gradient[0] = to_vec3(kernels::spring_gradient(
            to_real3(x[0]), to_real3(x[1]), springs_.rest_length(spring), stiffness(spring)));
        gradient[1] = -gradient[0];
    }

    void hessian(int spring, const Vec3* x, Mat3* blocks) const override {
        const Mat3 block = to_mat3(kernels::spring_exact_hessian(
            to_real3(x[0]), to_real3(x[1]), springs_.rest_length(spring), stiffness(spring)));
        blocks[0] = blocks[3] = block;
        blocks[1] = blocks[2] = -1.0 * block;
    }

private:
    double stiffness(int spring) const { return springs_.stiffness(spring); }

    const Springs& springs_;
};

}  // namespace

std::unique_ptr<ElementEnergies> make_spring_energies(const Springs& springs) {
    return std::make_unique<SpringEnergies>(springs);
}

}  // namespace weft
