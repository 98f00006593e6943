// What rounds of steps of bodies as wholes read of each other.

#include "kernels/contact/bodies.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/kernels/run_on_host.h"

namespace weft::test {
namespace {

using namespace kernels;

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// One body of one run, on which solve_bodies is run.
struct OneBody {
    Buffer<float4> lags{"lags", 2 * WEFT_BODY_PARTS}, rests{"rests", 7}, motions{"motions", 4},
        strains{"strains", 4}, bearings{"bearings", 2 * WEFT_BEARING_PARTS},
        moments{"moments", 2 * WEFT_MOMENT_PARTS};
    Buffer<int> first{"first_run", 1};
    Buffer<float> counts{"counts", 1}, masses{"masses", 1};

    OneBody() { counts[0] = masses[0] = 1.0f; }

    /// What each part of the sum is; there are two runs, of which the second one is nobody's.
    float4& part(std::size_t number) { return lags[2 * number]; }
    void solve(int has_moved, float held = 0.0f) {
        const Launch launched =
            launch(kernels::solve_bodies, Segments{}, lags, first, counts, masses, moments, motions,
                   strains, rests, bearings, has_moved, 0, 1, 1, 2, 1, held);
        run_on_host(launched, launched.kernel->scalar, 0, 1);
    }
};

/// A substep that ended badly is done again from its start, but nobody takes back how far bodies
/// went in its rounds.
TEST(BodiesAsWholes, TheFirstRoundReadsNothingOfAnEarlierSubstep) {
    OneBody body;
    for (float4& motion : body.motions.span()) motion = {kNone, kNone, kNone, kNone};
    body.part(5) = {0.5f, 0.0f, 0.0f, 0.0f};
    body.solve(0);
    EXPECT_EQ(body.motions[0].x, 0.5f);
    body.solve(1);
    EXPECT_EQ(body.motions[0].x, 1.0f);
}

TEST(BodiesAsWholes, NorDoTheSumsOfTheFirstRound) {
    Buffer<float4> standing("standing", 1), motions("motions", 4),
        moments("moments", WEFT_MOMENT_PARTS), strains("strains", 4),
        bearings("bearings", 2 * WEFT_BEARING_PARTS);
    standing[0] = {0.25f, 0.0f, 0.0f, 1.0f};
    Buffer<int> bodies("column_bodies", 1), rows("rows", 2), counts("counts", 1), codes("codes", 1);
    Buffer<float> masses("masses", 1), presses("presses", 1);
    masses[0] = 1.0f;
    Buffer<float4> entries("entries", 1), partials("partials", WEFT_BODY_PARTS);
    const auto lag_of_round = [&](int has_moved) {
        const Launch launched =
            launch(kernels::add_pushed_lags, Segments{}, standing, bodies, masses, moments, motions,
                   strains, bearings, rows, counts, codes, entries, entries, entries, entries,
                   entries, presses, partials, 0.0f, 1.0f, 1e-4f, 0, has_moved, 0, 0, 0, 1, 1);
        run_on_host(launched, launched.kernel->scalar, 0, 1);
        return partials[5].x;
    };
    for (float4& motion : motions.span()) motion = {kNone, kNone, kNone, kNone};
    EXPECT_EQ(lag_of_round(0), 0.25f);
    for (float4& motion : motions.span()) motion = {0.125f, 0.0f, 0.0f, 0.0f};
    EXPECT_EQ(lag_of_round(1), 0.125f);
}

/// One contact of one body, on which sums are run.
struct OneContact {
    static constexpr float kPress = 50.0f, kFriction = 0.5f, kRange = 0.02f, kYielding = 1e-4f;
    Buffer<float4> standing{"standing", 1}, motions{"motions", 4}, moments{"moments", 14},
        strains{"strains", 4}, bearings{"bearings", 2 * WEFT_BEARING_PARTS}, sides{"sides", 1},
        slips{"slips", 1}, forces{"forces", 1}, points{"points", 1}, others{"other_points", 1},
        partials{"partials", WEFT_RUBBED_BODY_PARTS};
    Buffer<int> bodies{"column_bodies", 1}, rows{"rows", 2}, counts{"counts", 1}, codes{"codes", 1};
    Buffer<float> masses{"masses", 1}, presses{"presses", 1};

    OneContact() {
        counts[0] = 1;
        codes[0] = 4;
        masses[0] = 1.0f;
        slips[0] = {0.01f, 0.0f, 0.0f, kRange};
        forces[0] = {1.0f, 2.0f, 1e4f, kRange};
        presses[0] = kPress;
        points[0].w = WEFT_RESTS_NOT;
    }
    /// What pushes the body along x and y.
    float4 lag_at(float gap, int has_moved) {
        sides[0] = {0.0f, 1.0f, 0.0f, gap};
        const Launch launched =
            launch(kernels::add_pushed_lags, Segments{}, standing, bodies, masses, moments, motions,
                   strains, bearings, rows, counts, codes, sides, slips, forces, points, others,
                   presses, partials, kFriction, 1e-3f, kYielding, 1, has_moved, 0, 0, 0, 1, 1);
        run_on_host(launched, launched.kernel->scalar, 0, 1);
        return partials[5];
    }
};

/// What presses are is known before the rounds begin, whatever the gaps are by now.
TEST(BodiesAsWholes, InTheFirstRoundContactsRubByThePressesThatTheyHave) {
    for (const float gap : {1.5f, 0.6f}) {
        OneContact contact;
        const float4 lag = contact.lag_at(gap * OneContact::kRange, 0);
        const float rubbed = OneContact::kYielding * OneContact::kFriction * OneContact::kPress;
        EXPECT_NEAR(lag.x, -rubbed, 1e-6f * rubbed);
        const float press = gap < 1.0f ? 1e4f * (1.0f - gap) * OneContact::kRange : 0.0f;
        EXPECT_NEAR(lag.y, OneContact::kYielding * press, 1e-5f * OneContact::kYielding * press);
        EXPECT_NEAR(contact.presses[0], 0.5f * (OneContact::kPress + press), 1e-3f);
    }
}

/// A contact may press far too hard for a round: what rubs is what bears the body.
TEST(BodiesAsWholes, BehindItTheyRubByWhatBearsTheBody) {
    OneContact contact;
    contact.lag_at(0.6f * OneContact::kRange, 0);
    constexpr float kMean = 0.5f * (50.0f + 80.0f) * OneContact::kYielding;
    EXPECT_NEAR(contact.partials[13].y, kMean, 1e-5f * kMean);
    EXPECT_EQ(contact.partials[15].y, 0.0f) << "not known yet who tells";
    constexpr float kBorne = 0.3f * kMean;
    contact.bearings[0] = {0.0f, kBorne, 0.0f, kMean};
    contact.bearings[2] = {0.0f, kMean, 0.0f, 0.0f};
    const float rubbed = OneContact::kFriction * kBorne;
    EXPECT_NEAR(contact.lag_at(0.6f * OneContact::kRange, 1).x, -rubbed, 0.01f * rubbed);
    EXPECT_FLOAT_EQ(contact.partials[15].y, contact.partials[13].y);
}

/// How it moves in a scene without contacts.
body_motion motion_alone(OneBody& body, float held = 0.0f) {
    Buffer<float4> sums("sums", 2 * WEFT_MOMENT_PARTS), motions("motions", 6);
    for (std::size_t part = 0; part < WEFT_MOMENT_PARTS; ++part) {
        sums[part] = body.moments[2 * part];
    }
    const Launch launched =
        launch(kernels::solve_runs, Segments{}, sums, body.first, body.counts, motions, 1, 1, held);
    run_on_host(launched, launched.kernel->scalar, 0, 1);
    return gather_motion(motions.data(), 2, 0);
}

/// With the bits of a scene without contacts, which takes no rounds.
TEST(BodiesAsWholes, ABodyThatTouchesNothingTakesTheStepOfOneAlone) {
    OneBody body;
    body.part(5) = {0.5f, 0.25f, -0.125f, 0.0f};
    body.moments[0].w = body.moments[2].z = body.moments[4].w = 0.01f;
    body.moments[6].y = 1e-4f;
    body.moments[8].z = 3e-4f;

    const body_motion alone = motion_alone(body);
    ASSERT_NEAR(alone.turn.z, -0.005, 1e-4);
    for (int round = 0; round < 3; ++round) {
        body.solve(round == 0 ? 0 : 1);
        body.part(5) = {0.0f, 0.0f, 0.0f, 0.0f};
        EXPECT_EQ(body.motions[0].y, 0.25f);
        EXPECT_EQ(body.motions[2].x, alone.turn.x);
        EXPECT_EQ(body.motions[2].y, alone.turn.y);
        EXPECT_EQ(body.motions[2].z, alone.turn.z);
    }
}

/// As in scenes without contact, what hangs from what it drapes over would turn it.
TEST(BodiesAsWholes, ClothThatAnObstacleTouchesIsNotTurned) {
    for (const float pushed : {0.0f, 1e-6f}) {
        OneBody body;
        body.part(5) = {0.5f, 0.25f, -0.125f, 0.0f};
        body.moments[0].w = body.moments[2].z = body.moments[4].w = 0.01f;
        body.moments[6].y = 1e-4f;
        body.moments[12].w = pushed;
        body.solve(0);
        EXPECT_EQ(body.motions[0].y, 0.25f);
        EXPECT_EQ(body.motions[2].z == 0.0f, pushed > 0.0f);
    }
}

/// By as much as if a spring led from what is on an obstacle to where it is, in all rounds
/// together.
TEST(BodiesAsWholes, WhatObstaclesHoldIsShiftedTheLess) {
    constexpr float kLag = 0.5f, kHeld = 50.0f, kPushed = 0.25f;
    OneBody body;
    body.moments[12].w = kPushed;
    body.part(5) = {kLag, 0.0f, 0.0f, 0.0f};
    body.solve(0, kHeld);
    const float shift = kLag / (1.0f + kHeld * kPushed);
    EXPECT_FLOAT_EQ(body.motions[0].x, shift);
    body.part(5) = {kLag - shift, 0.0f, 0.0f, 0.0f};
    body.solve(1, kHeld);
    EXPECT_NEAR(body.motions[0].x, shift, 1e-7f);
}

/// Of body 1, which is on no level of the other one's group.
constexpr int kCodeOfOne = 1 << WEFT_LEVEL_BITS;

/// Two edges that cross, of a body each.
struct CrossedEdges {
    static constexpr int kVertices = 4, kRoom = 4, kLevels = 2;
    Buffer<float4> positions{"positions", kVertices}, targets{"targets", kVertices};
    Buffer<int> members{"members", 2 * WEFT_RUN_COLUMNS}, columns{"column_rows", 4},
        bodies{"bodies", kVertices}, leaders{"leaders", 2 * kLevels};
    Buffer<float> shares{"shares", 2 * WEFT_RUN_COLUMNS};
    Buffer<int> rows{"rows", 2 * kVertices}, counts{"counts", kVertices};
    Buffer<int> corner0{"corner0", kVertices}, corner1{"corner1", kVertices},
        corner2{"corner2", kVertices}, corner3{"corner3", kVertices};
    Buffer<float4> normals{"normals", kVertices}, weights{"weights", kVertices},
        measures{"measures", kVertices};
    Buffer<float> multipliers{"multipliers", kVertices},
        presses{"presses", 2 * WEFT_ROW_STRIDE*kRoom};
    Buffer<int> push_rows{"push_rows", 4}, push_counts{"push_counts", 2},
        push_needs{"push_needs", 2}, codes{"codes", 2 * WEFT_ROW_STRIDE*kRoom};
    Buffer<float4> sides{"sides", codes.count()}, slips{"slips", codes.count()},
        forces{"forces", codes.count()}, points{"points", codes.count()},
        other_points{"other_points", codes.count()}, standing{"standing", 2};

    /// The first edge weighs 1/4 and 3/4, the second one 1/2 and 1/2; 0.01 m apart.
    CrossedEdges() {
        const float quarters[4] = {0.25f, 0.75f, -0.5f, -0.5f};
        positions[0] = {-0.75f, 0.01f, 0.0f, 1.0f};
        positions[1] = {0.25f, 0.01f, 0.0f, 1.0f};
        positions[2] = {0.0f, 0.0f, -0.5f, 1.0f};
        positions[3] = {0.0f, 0.0f, 0.5f, 1.0f};
        for (int v = 0; v < kVertices; ++v) {
            const auto e = static_cast<std::size_t>(v);
            const float side = v < 2 ? 1.0f : -1.0f;
            const float own = side * quarters[v];
            rows[e] = v;
            rows[e + kVertices] = 1;
            counts[e] = 1;
            corner1[e] = 1;
            corner2[e] = 2;
            corner3[e] = 3;
            bodies[e] = v / 2;
            normals[e] = {0.0f, side, 0.0f, 0.01f};
            multipliers[e] = 0.5f;
            weights[e] = {side * quarters[0], side * quarters[1], side * quarters[2],
                          side * quarters[3]};
            measures[e] = {own, 2.0f * own, 100.0f, 0.02f};
        }
        for (std::size_t level = 0; level < kLevels; ++level) leaders[2 * level + 1] = 1;
        for (std::size_t body = 0; body < 2; ++body) {
            columns[2 * body] = static_cast<int>(body);
            columns[2 * body + 1] = 2;
            push_rows[body] = static_cast<int>(body);
            push_rows[body + 2] = kRoom;
            for (std::size_t k = 0; k < 2; ++k) {
                members[body + WEFT_RUN_COLUMNS * k] = static_cast<int>(2 * body + k);
                shares[body + WEFT_RUN_COLUMNS * k] = 0.5f;
            }
        }
    }

    void collect(int free_bodies = 2) {
        const Launch launched =
            launch(kernels::collect_pushes, Segments{}, positions, targets, members, shares,
                   columns, bodies, leaders, rows, counts, corner0, corner1, corner2, corner3,
                   normals, weights, measures, normals, multipliers, push_rows, push_counts,
                   push_needs, codes, sides, slips, forces, points, other_points, presses, standing,
                   2, free_bodies, kLevels, 0.5f, 1, 100.0f, 0);
        run_on_host(launched, launched.kernel->scalar, 0, 2);
    }
};

TEST(BodiesAsWholes, EachSideHasAContactOnceWithAllOfItsWeight) {
    CrossedEdges edges;
    edges.collect();
    for (std::size_t body = 0; body < 2; ++body) {
        ASSERT_EQ(edges.push_counts[body], 1);
        EXPECT_EQ(edges.push_needs[body], 1);
        EXPECT_EQ(edges.codes[body], kCodeOfOne * (1 - static_cast<int>(body)));
        EXPECT_NEAR(edges.sides[body].w, 0.01f, 1e-7f);
        EXPECT_EQ(edges.forces[body].x, 1.0f);
        EXPECT_EQ(edges.forces[body].y, 2.0f);
        EXPECT_EQ(edges.standing[body].w, 1.0f);
        EXPECT_EQ(edges.presses[body], 50.0f);
        EXPECT_NEAR(edges.points[body].x, 0.0f, 1e-7f);
        EXPECT_NEAR(edges.points[body].y, 0.005f, 1e-7f);
        EXPECT_EQ(edges.points[body].y, edges.other_points[body].y);
        EXPECT_EQ(edges.points[body].y, edges.points[1 - body].y)
            << "else what rubs both would turn them in common";
    }
}

TEST(BodiesAsWholes, WhatIsHeldIsTouchedWhereTheSurfaceIs) {
    CrossedEdges edges;
    edges.collect(1);
    EXPECT_NEAR(edges.points[0].y, 0.01f, 1e-7f);
    EXPECT_NEAR(edges.other_points[0].y, 0.0f, 1e-7f);
}

TEST(BodiesAsWholes, ContactsKnowOnHowManyLevelsBothSidesAreOfOneGroup) {
    CrossedEdges edges;
    edges.leaders[1] = 0;
    edges.collect();
    EXPECT_EQ(edges.codes[0], kCodeOfOne + 1);
    EXPECT_EQ(edges.codes[1], 1);
    edges.leaders[3] = 0;
    edges.collect();
    EXPECT_EQ(edges.codes[0], kCodeOfOne + 2);
}

TEST(BodiesAsWholes, ContactsOfABodyWithItselfDoNotPushIt) {
    CrossedEdges edges;
    edges.bodies[2] = edges.bodies[3] = 0;
    edges.collect();
    EXPECT_EQ(edges.push_counts[0], 0);
    EXPECT_EQ(edges.push_counts[1], 0);
}

}  // namespace
}  // namespace weft::test
