#include "simulation/families/in_double.h"
// The language layer in double precision has to come before all else.
#include "kernels/energies/tetrahedron.h"
#include "simulation/families/sum_of_energies.h"
#include "simulation/families/tetrahedra/tetrahedra.h"

namespace weft {

namespace {

kernels::real3 b(const Tetrahedra& all, int tetrahedron, int corner) {
    const auto [x, y, z] = all.shape_gradient(tetrahedron, corner);
    return kernels::make3(x, y, z);
}

kernels::tetrahedron deformed(const Tetrahedra& all, int tetrahedron, const Vec3* x) {
    return kernels::make_tetrahedron(
        kernels::tetrahedron_map(to_real3(x[0]), to_real3(x[1]), to_real3(x[2]), to_real3(x[3]),
                                 b(all, tetrahedron, 1), b(all, tetrahedron, 2),
                                 b(all, tetrahedron, 3)),
        all.mu(tetrahedron), all.lambda(tetrahedron));
}

}  // namespace

double Tetrahedra::energy(int tetrahedron, const Vec3* x) const {
    return kernels::tetrahedron_energy(deformed(*this, tetrahedron, x));
}

namespace {

WEFT_WIDE double sum_of(const Tetrahedra& all, int begin, int end,
                        std::span<const float4> positions) {
    return sum_of_energies<4>(all, begin, end, positions);
}

}  // namespace

double Tetrahedra::sum_energies(int begin, int end, std::span<const float4> positions) const {
    return sum_of(*this, begin, end, positions);
}

void Tetrahedra::gradient(int tetrahedron, const Vec3* x, Vec3* gradient) const {
    const kernels::tetrahedron t = deformed(*this, tetrahedron, x);
    for (int j = 0; j < 4; ++j) {
        gradient[j] = to_vec3(kernels::tetrahedron_gradient(t, b(*this, tetrahedron, j)));
    }
}

void Tetrahedra::hessian(int tetrahedron, const Vec3* x, Mat3* blocks) const {
    const kernels::tetrahedron t = deformed(*this, tetrahedron, x);
    for (int j = 0; j < 4; ++j) {
        for (int k = 0; k < 4; ++k) {
            blocks[4 * j + k] = to_mat3(
                kernels::tetrahedron_block(t, b(*this, tetrahedron, j), b(*this, tetrahedron, k)));
        }
    }
}

}  // namespace weft
