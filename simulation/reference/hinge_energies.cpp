#include "simulation/reference/in_double.h"
// The language layer in double precision has to come before all else.
#include "kernels/energies/hinge.h"
#include "simulation/reference/element_energies.h"

namespace weft {

namespace {

class HingeEnergies final : public ElementEnergies {
public:
    explicit HingeEnergies(const Hinges& hinges) : hinges_(hinges) {}

    int count() const override { return hinges_.elements.count(); }
    std::span<const int> corners(int hinge) const override {
        return hinges_.elements.vertices_of(hinge);
    }

    double energy(int hinge, const Vec3* x) const override {
        return kernels::hinge_energy(bend(weights(hinge), x));
    }

    void gradient(int hinge, const Vec3* x, Vec3* gradient) const override {
        const auto q = weights(hinge);
        const kernels::real3 b = bend(q, x);
        for (std::size_t k = 0; k < 4; ++k) {
            gradient[k] = to_vec3(kernels::hinge_gradient(b, q[k]));
        }
    }

    void hessian(int hinge, const Vec3*, Mat3* blocks) const override {
        const auto q = weights(hinge);
        for (std::size_t j = 0; j < 4; ++j) {
            for (std::size_t k = 0; k < 4; ++k) {
                blocks[4 * j + k] = kernels::hinge_hessian(q[j], q[k]) * Mat3{};
            }
        }
    }

private:
    /// The first one is the others' negative sum, as the element functions have it: the rounded
    /// one in the buffer would make a force that is not the energy's.
    std::array<double, 4> weights(int hinge) const {
        std::array<double, 4> q{};
        const auto count = static_cast<std::size_t>(hinges_.elements.count());
        for (std::size_t k = 1; k < 4; ++k) {
            q[k] =
                static_cast<double>(hinges_.weights[k * count + static_cast<std::size_t>(hinge)]);
            q[0] -= q[k];
        }
        return q;
    }

    static kernels::real3 bend(const std::array<double, 4>& q, const Vec3* x) {
        return kernels::hinge_bend(to_real3(x[0]), to_real3(x[1]), to_real3(x[2]), to_real3(x[3]),
                                   q[1], q[2], q[3]);
    }

    const Hinges& hinges_;
};

}  // namespace

std::unique_ptr<ElementEnergies> make_hinge_energies(const Hinges& hinges) {
    return std::make_unique<HingeEnergies>(hinges);
}

}  // namespace weft
