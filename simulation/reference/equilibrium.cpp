#include "simulation/reference/equilibrium.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace weft {

namespace {

constexpr int kMostRounds = 300;
/// The relative gap that other forces may make of a minimum: then these are the ones.
constexpr double kSettled = 1e-13;

}  // namespace

Minimum find_equilibrium(IncrementalPotential& potential, std::vector<Vec3> start,
                         const std::function<void(const Certificate&)>& progress, double enough) {
    if (!potential.rubs()) return minimise(potential, std::move(start), progress, enough);
    int iterations = 0;
    for (int round = 0;; ++round) {
        potential.press_as_at(start);
        std::optional<double> first_gap;
        const auto look = [&](const Certificate& certificate) {
            if (!first_gap) first_gap = certificate.relative_gap;
            if (progress) progress(certificate);
        };
        Minimum minimum = minimise(potential, std::move(start), look, std::max(enough, kSettled));
        iterations += minimum.certificate.iterations;
        const bool is_settled = minimum.certificate.iterations == 0;
        if (is_settled || round == kMostRounds) {
            if (!is_settled) minimum.certificate.relative_gap = *first_gap;
            minimum.certificate.iterations = iterations;
            return minimum;
        }
        start = std::move(minimum.x);
    }
}

}  // namespace weft
