#include "simulation/families/in_double.h"
// The language layer in double precision has to come before all else.
#include "kernels/energies/stitch.h"
#include "simulation/families/stitches/stitches.h"
#include "simulation/families/sum_of_energies.h"

namespace weft {

namespace {

double rest_of(const Stitches& all, int stitch) {
    return kernels::stitch_rest(all.start(stitch), all.rate(stitch), (*all.clock)[0]);
}

double energy_of(const Stitches& all, int stitch, const Vec3* x, double rest) {
    return kernels::spring_energy(to_real3(x[0]), to_real3(x[1]), rest, all.stiffness(stitch));
}

/// The stitches at a time, as sum_of_energies() asks for them.
struct StitchesAt {
    const Stitches& all;
    float time;  ///< [s]

    const Elements& elements() const { return all.elements(); }
    int count() const { return all.count(); }
    double energy(int stitch, const Vec3* x) const {
        return energy_of(all, stitch, x,
                         kernels::stitch_rest(all.start(stitch), all.rate(stitch), time));
    }
};

WEFT_WIDE double sum_of(const StitchesAt& at, int begin, int end,
                        std::span<const float4> positions) {
    return sum_of_energies<2>(at, begin, end, positions);
}

}  // namespace

double Stitches::energy(int stitch, const Vec3* x) const {
    return energy_of(*this, stitch, x, rest_of(*this, stitch));
}

double Stitches::sum_energies(int begin, int end, std::span<const float4> positions) const {
    return sum_of({*this, (*clock)[0]}, begin, end, positions);
}

double Stitches::sum_energies_at(double time, int begin, int end,
                                 std::span<const float4> positions) const {
    return sum_of({*this, static_cast<float>(time)}, begin, end, positions);
}

void Stitches::gradient(int stitch, const Vec3* x, Vec3* gradient) const {
    gradient[0] = to_vec3(kernels::spring_gradient(to_real3(x[0]), to_real3(x[1]),
                                                   rest_of(*this, stitch), stiffness(stitch)));
    gradient[1] = -gradient[0];
}

void Stitches::hessian(int stitch, const Vec3* x, Mat3* blocks) const {
    const Mat3 block = to_mat3(kernels::spring_exact_hessian(
        to_real3(x[0]), to_real3(x[1]), rest_of(*this, stitch), stiffness(stitch)));
    blocks[0] = blocks[3] = block;
    blocks[1] = blocks[2] = -1.0 * block;
}

}  // namespace weft
