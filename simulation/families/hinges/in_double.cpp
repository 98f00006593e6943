#include "simulation/families/in_double.h"
// The language layer in double precision has to come before all else.
#include "kernels/energies/hinge.h"
#include "simulation/families/hinges/hinges.h"
#include "simulation/families/sum_of_energies.h"

namespace weft {

namespace {

/// The first one is the others' negative sum, as the element functions have it: the rounded one in
/// the buffer would make a force that is not the energy's.
std::array<double, 4> weights_of(const Hinges& hinges, int hinge) {
    std::array<double, 4> q{};
    for (int k = 1; k < 4; ++k) {
        q[static_cast<std::size_t>(k)] = hinges.weight(hinge, k);
        q[0] -= hinges.weight(hinge, k);
    }
    return q;
}

kernels::real3 bend(const std::array<double, 4>& q, const Vec3* x) {
    return kernels::hinge_bend(to_real3(x[0]), to_real3(x[1]), to_real3(x[2]), to_real3(x[3]), q[1],
                               q[2], q[3]);
}

}  // namespace

double Hinges::energy(int hinge, const Vec3* x) const {
    return kernels::hinge_energy(bend(weights_of(*this, hinge), x));
}

namespace {

WEFT_WIDE double sum_of(const Hinges& all, int begin, int end, std::span<const float4> positions) {
    return sum_of_energies<4>(all, begin, end, positions);
}

}  // namespace

double Hinges::sum_energies(int begin, int end, std::span<const float4> positions) const {
    return sum_of(*this, begin, end, positions);
}

void Hinges::gradient(int hinge, const Vec3* x, Vec3* gradient) const {
    const auto q = weights_of(*this, hinge);
    const kernels::real3 b = bend(q, x);
    for (std::size_t k = 0; k < 4; ++k) gradient[k] = to_vec3(kernels::hinge_gradient(b, q[k]));
}

void Hinges::hessian(int hinge, const Vec3*, Mat3* blocks) const {
    const auto q = weights_of(*this, hinge);
    for (std::size_t j = 0; j < 4; ++j) {
        for (std::size_t k = 0; k < 4; ++k) {
            blocks[4 * j + k] = kernels::hinge_hessian(q[j], q[k]) * Mat3{};
        }
    }
}

}  // namespace weft
