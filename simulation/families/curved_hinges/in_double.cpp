#include "simulation/families/in_double.h"
// The language layer in double precision has to come before all else.
#include "kernels/energies/curved_hinge.h"
#include "simulation/families/curved_hinges/curved_hinges.h"
#include "simulation/families/sum_of_energies.h"

namespace weft {

namespace {

/// A hinge as seen from one of its corners.
struct Seen {
    kernels::real3 bend, spin;
    double weight;
};

Seen see(const CurvedHinges& hinges, int hinge, int corner, const Vec3* x) {
    const auto [q1, q2, q3, p12, p13, p23] = hinges.seen_from(hinge, corner);
    const kernels::curved_hinge h{q1, q2, q3, p12, p13, p23};
    const auto from = [&](int step) { return to_real3(x[(corner + step) % 4] - x[corner]); };
    return {kernels::curved_hinge_bend(h, from(1), from(2), from(3)),
            kernels::curved_hinge_spin(h, from(1), from(2), from(3)),
            kernels::curved_hinge_weight(h)};
}

}  // namespace

double CurvedHinges::energy(int hinge, const Vec3* x) const {
    const kernels::real3 b = see(*this, hinge, 0, x).bend;
    return 0.5 * kernels::dot3(b, b);
}

namespace {

WEFT_WIDE double sum_of(const CurvedHinges& all, int begin, int end,
                        std::span<const float4> positions) {
    return sum_of_energies<4>(all, begin, end, positions);
}

}  // namespace

double CurvedHinges::sum_energies(int begin, int end, std::span<const float4> positions) const {
    return sum_of(*this, begin, end, positions);
}

void CurvedHinges::gradient(int hinge, const Vec3* x, Vec3* gradient) const {
    for (int k = 0; k < 4; ++k) {
        const Seen s = see(*this, hinge, k, x);
        gradient[k] = to_vec3(kernels::curved_hinge_gradient(s.bend, s.weight, s.spin));
    }
}

void CurvedHinges::hessian(int hinge, const Vec3* x, Mat3* blocks) const {
    std::array<Seen, 4> at{};
    for (int k = 0; k < 4; ++k) at[static_cast<std::size_t>(k)] = see(*this, hinge, k, x);
    for (int j = 0; j < 4; ++j) {
        for (int k = 0; k < 4; ++k) {
            const Seen& a = at[static_cast<std::size_t>(j)];
            const Seen& b = at[static_cast<std::size_t>(k)];
            blocks[4 * j + k] = to_mat3(kernels::curved_hinge_coupling(
                a.bend, a.weight, a.spin, b.weight, b.spin, pair_weight(hinge, j, k)));
        }
    }
}

}  // namespace weft
