#include "simulation/families/in_double.h"
// The language layer in double precision has to come before all else.
#include "kernels/energies/woven.h"
#include "simulation/families/sum_of_energies.h"
#include "simulation/families/woven/woven.h"

namespace weft {

namespace {

kernels::real2 b(const WovenCloth& all, int triangle, int corner) {
    const auto [u, v] = all.shape_gradient(triangle, corner);
    return kernels::make2(u, v);
}

kernels::woven deformed(const WovenCloth& all, int triangle, const Vec3* x) {
    return kernels::make_woven(to_real3(x[0]), to_real3(x[1]), to_real3(x[2]), b(all, triangle, 1),
                               b(all, triangle, 2), all.stiffness(triangle, 0),
                               all.stiffness(triangle, 1), all.stiffness(triangle, 2));
}

}  // namespace

double WovenCloth::energy(int triangle, const Vec3* x) const {
    return kernels::woven_energy(deformed(*this, triangle, x));
}

namespace {

WEFT_WIDE double sum_of(const WovenCloth& all, int begin, int end,
                        std::span<const float4> positions) {
    return sum_of_energies<3>(all, begin, end, positions);
}

}  // namespace

double WovenCloth::sum_energies(int begin, int end, std::span<const float4> positions) const {
    return sum_of(*this, begin, end, positions);
}

void WovenCloth::gradient(int triangle, const Vec3* x, Vec3* gradient) const {
    const kernels::woven w = deformed(*this, triangle, x);
    for (int j = 0; j < 3; ++j) {
        gradient[j] = to_vec3(kernels::woven_gradient(w, b(*this, triangle, j)));
    }
}

void WovenCloth::hessian(int triangle, const Vec3* x, Mat3* blocks) const {
    const kernels::woven w = deformed(*this, triangle, x);
    for (int j = 0; j < 3; ++j) {
        for (int k = 0; k < 3; ++k) {
            blocks[3 * j + k] =
                to_mat3(kernels::woven_block(w, b(*this, triangle, j), b(*this, triangle, k)));
        }
    }
}

}  // namespace weft
