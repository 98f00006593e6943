#include "simulation/families/in_double.h"
// The language layer in double precision has to come before all else.
#include "kernels/energies/membrane.h"
#include "simulation/families/membranes/membranes.h"
#include "simulation/families/sum_of_energies.h"

namespace weft {

namespace {

kernels::real2 b(const Membranes& all, int triangle, int corner) {
    const auto [u, v] = all.shape_gradient(triangle, corner);
    return kernels::make2(u, v);
}

kernels::membrane deformed(const Membranes& all, int triangle, const Vec3* x) {
    return kernels::make_membrane(to_real3(x[0]), to_real3(x[1]), to_real3(x[2]),
                                  b(all, triangle, 1), b(all, triangle, 2), all.mu(triangle),
                                  all.lambda(triangle));
}

}  // namespace

double Membranes::energy(int triangle, const Vec3* x) const {
    return kernels::membrane_energy(deformed(*this, triangle, x));
}

namespace {

WEFT_WIDE double sum_of(const Membranes& all, int begin, int end,
                        std::span<const float4> positions) {
    return sum_of_energies<3>(all, begin, end, positions);
}

}  // namespace

double Membranes::sum_energies(int begin, int end, std::span<const float4> positions) const {
    return sum_of(*this, begin, end, positions);
}

void Membranes::gradient(int triangle, const Vec3* x, Vec3* gradient) const {
    const kernels::membrane m = deformed(*this, triangle, x);
    for (int j = 0; j < 3; ++j) {
        gradient[j] = to_vec3(kernels::membrane_gradient(m, b(*this, triangle, j)));
    }
}

void Membranes::hessian(int triangle, const Vec3* x, Mat3* blocks) const {
    const kernels::membrane m = deformed(*this, triangle, x);
    for (int j = 0; j < 3; ++j) {
        for (int k = 0; k < 3; ++k) {
            blocks[3 * j + k] =
                to_mat3(kernels::membrane_block(m, b(*this, triangle, j), b(*this, triangle, k)));
        }
    }
}

}  // namespace weft
