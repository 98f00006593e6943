// Devices that are good at different kinds of tasks: the machine's times are made up, and free of
// noise.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/runtime/planning/planned.h"

namespace weft::test {
namespace {

constexpr double kLatency = 20e-6;
constexpr int kAcross = 100, kAlong = 400;

/// XPBD's kinds are predict, seams, strips, velocities. At seams the first device is 10 times as
/// fast as the second one, at all else half as fast.
std::vector<VirtualMachine::Speed> opposites(double seams) {
    return {{0.5e-6, 20e-9, {1.0, seams, 1.0, 1.0}},
            {0.5e-6, 10e-9, {1.0, 20.0 * seams, 1.0, 1.0}}};
}

/// What no plan can undercut, whatever its tasks: kinds shared at will between two devices, those
/// first to the first one that it is best at, without fixed costs and exchanges.
double least_time(const Planned& p) {
    const auto items = p.items();
    const auto cost = [&](std::size_t device, std::size_t kind) {
        const VirtualMachine::Speed& speed = p.machine.speeds[device];
        return items[kind] * speed.per_item * speed.by_kind[kind];
    };
    std::vector<std::size_t> kinds(items.size());
    std::iota(kinds.begin(), kinds.end(), 0U);
    std::ranges::sort(kinds, {}, [&](std::size_t k) { return cost(0, k) / cost(1, k); });
    double first = 0.0, second = 0.0;
    for (const std::size_t k : kinds) second += cost(1, k);
    for (const std::size_t k : kinds) {
        if (first + cost(0, k) >= second - cost(1, k)) {
            const double share = (second - first) / (cost(0, k) + cost(1, k));
            return kSubsteps * (first + share * cost(0, k));
        }
        first += cost(0, k);
        second -= cost(1, k);
    }
    return kSubsteps * first;
}

double best_division(double seams) {
    const Planned sample(kAcross, kAlong, opposites(seams), kLatency);
    double best = 1e9;
    for (int first = 0; first <= sample.strip_count(); first += 2) {
        Planned p(kAcross, kAlong, opposites(seams), kLatency, PlanKind::kExact, {},
                  Division{{first, sample.strip_count() - first}});
        best = std::min(best, p.advance(3).measured);
    }
    return best;
}

TEST(Placement, BeatsEveryDivisionAndComesNearTheBound) {
    for (const double seams : {2.0, 3.0, 6.0}) {
        Planned p(kAcross, kAlong, opposites(seams), kLatency);
        const auto frame = p.advance(40);
        EXPECT_TRUE(frame.placed) << seams;
        const double divided = best_division(seams);
        EXPECT_LT(frame.measured, 0.97 * divided) << seams;
        RecordProperty("placed_over_bound_" + std::to_string(seams),
                       std::to_string(frame.measured / least_time(p)));
        RecordProperty("divided_over_placed_" + std::to_string(seams),
                       std::to_string(divided / frame.measured));
        EXPECT_LT(frame.measured, 1.03 * least_time(p)) << seams;
    }
}

}  // namespace
}  // namespace weft::test
