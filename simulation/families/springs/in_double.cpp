#include "simulation/families/in_double.h"
// The language layer in double precision has to come before all else.
#include "kernels/energies/spring.h"
#include "simulation/families/springs/springs.h"
#include "simulation/families/sum_of_energies.h"

namespace weft {

double Springs::energy(int spring, const Vec3* x) const {
    return kernels::spring_energy(to_real3(x[0]), to_real3(x[1]), rest_length(spring),
                                  stiffness(spring));
}

namespace {

WEFT_WIDE double sum_of(const Springs& all, int begin, int end, std::span<const float4> positions) {
    return sum_of_energies<2>(all, begin, end, positions);
}

}  // namespace

double Springs::sum_energies(int begin, int end, std::span<const float4> positions) const {
    return sum_of(*this, begin, end, positions);
}

void Springs::gradient(int spring, const Vec3* x, Vec3* gradient) const {
    gradient[0] = to_vec3(kernels::spring_gradient(to_real3(x[0]), to_real3(x[1]),
                                                   rest_length(spring), stiffness(spring)));
    gradient[1] = -gradient[0];
}

void Springs::hessian(int spring, const Vec3* x, Mat3* blocks) const {
    const Mat3 block = to_mat3(kernels::spring_exact_hessian(
        to_real3(x[0]), to_real3(x[1]), rest_length(spring), stiffness(spring)));
    blocks[0] = blocks[3] = block;
    blocks[1] = blocks[2] = -1.0 * block;
}

}  // namespace weft
