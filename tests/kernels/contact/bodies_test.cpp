// What rounds of steps of bodies as wholes read of each other.

#include "kernels/contact/bodies.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/kernels/run_on_host.h"

namespace weft::test {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// A substep that ended badly is done again from its start, but nobody takes back how far bodies
/// went in its rounds.
TEST(BodiesAsWholes, TheFirstRoundReadsNothingOfAnEarlierSubstep) {
    Buffer<float4> shifts("shifts", 2);
    shifts[0] = {kNone, kNone, kNone, kNone};
    Buffer<float4> lags("lags", 2 * WEFT_BODY_PARTS), rests("rests", 3);
    lags[0] = {0.5f, 0.0f, 0.0f, 0.0f};
    Buffer<int> first("first_run", 1);
    Buffer<float> counts("counts", 1), masses("masses", 1);
    counts[0] = masses[0] = 1.0f;
    const auto solve = [&](int has_moved) {
        const Launch launched = launch(kernels::solve_bodies, Segments{}, lags, first, counts,
                                       masses, shifts, rests, has_moved, 1, 2, 1);
        run_on_host(launched, launched.kernel->scalar, 0, 1);
    };
    solve(0);
    EXPECT_EQ(shifts[0].x, 0.5f);
    solve(1);
    EXPECT_EQ(shifts[0].x, 1.0f);
}

TEST(BodiesAsWholes, NorDoTheSumsOfTheFirstRound) {
    Buffer<float4> positions("positions", 1), targets("targets", 1), shifts("shifts", 2);
    positions[0].w = 1.0f;
    targets[0] = {0.25f, 0.0f, 0.0f, 0.0f};
    Buffer<int> members("members", 1), columns("column_rows", 2), bodies("bodies", 1),
        leaders("leaders", 1), rows("rows", 2), counts("counts", 1), corner("corners", 1);
    Buffer<float> shares("shares", 1);
    shares[0] = 1.0f;
    columns[1] = 1;
    Buffer<float4> entries("entries", 1), partials("partials", WEFT_BODY_PARTS);
    const auto lag_of_round = [&](int has_moved) {
        const Launch launched =
            launch(kernels::add_pushed_lags, Segments{}, positions, targets, members, shares,
                   columns, bodies, leaders, shifts, rows, counts, corner, corner, corner, corner,
                   entries, entries, entries, partials, 0.0f, 1.0f, 1e-4f, has_moved, 1, 1, 0);
        run_on_host(launched, launched.kernel->scalar, 0, 1);
        return partials[0].x;
    };
    shifts[0] = {kNone, kNone, kNone, kNone};
    EXPECT_EQ(lag_of_round(0), 0.25f);
    shifts[0] = {0.125f, 0.0f, 0.0f, 0.0f};
    EXPECT_EQ(lag_of_round(1), 0.125f);
}

}  // namespace
}  // namespace weft::test
