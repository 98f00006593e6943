#include "simulation/model/load_paths.h"

#include <gtest/gtest.h>

#include "simulation/scene/read_scene.h"
#include "tests/simulation/model/load_path_scenes.h"

namespace weft::test {
namespace {

std::vector<LoadPath> paths_of(const std::string& text, bool with_ties = false, Vec3 gravity = {}) {
    Warnings warnings;
    const Gathered all = gather(parse_scene(text, "test.toml"), warnings);
    std::vector<Stencils> links;
    for (const auto& family : all.families) {
        if (with_ties && family->stencils().arity == 2) links.push_back(family->stencils());
    }
    return load_paths(all, links, gravity);
}

TEST(LoadPaths, RunFromTheFarthestVertexToThePins) {
    const auto paths = paths_of(kSheet + kPins);
    ASSERT_EQ(paths.size(), 1U);
    EXPECT_EQ(paths[0].levels, 20.0);
    EXPECT_EQ(paths[0].burden, 1.0);
    EXPECT_FALSE(paths[0].is_solid);
    // Edges of 0.1 m along both sides, and diagonals.
    EXPECT_GT(paths[0].edge, 0.1);
    EXPECT_LT(paths[0].edge, 0.13);
}

TEST(LoadPaths, OfWhatNothingHoldsAreHalfOfItsLength) {
    const auto paths = paths_of(kSheet);
    ASSERT_EQ(paths.size(), 1U);
    EXPECT_GE(paths[0].levels, 10.0);
    EXPECT_LE(paths[0].levels, 15.0);
}

TEST(LoadPaths, TiedBodiesBurdenTheLightest) {
    EXPECT_EQ(paths_of(kSheet + kPins + kBlock).size(), 2U);
    const auto paths = paths_of(kSheet + kPins + kBlock + kTies, true);
    ASSERT_EQ(paths.size(), 1U);
    EXPECT_EQ(paths[0].body, "sheet");
    EXPECT_NEAR(paths[0].burden, 8.4 / 0.4, 1e-9);
}

/// What pins hold all over carries nothing, however light it is.
TEST(LoadPaths, ThatAreHeldAllOverAreNotBurdened) {
    const std::string all_pinned = "pins = { box = [[-9.0, -9.0, -9.0], [9.0, 9.0, 9.0]] }\n";
    const auto paths = paths_of(kSheet + all_pinned + kBlock + kTies, true);
    ASSERT_EQ(paths.size(), 1U);
    EXPECT_EQ(paths[0].body, "block");
    EXPECT_EQ(paths[0].burden, 1.0);
}

/// Its volume is its surface times 0.0238 m.
TEST(LoadPaths, OfSolidsThatPinsHoldMayBeSlender) {
    const auto held = paths_of(kBeam + "pins = { faces = [\"x-\"] }\n");
    ASSERT_EQ(held.size(), 1U);
    EXPECT_NEAR(held[0].slender, held[0].levels * held[0].edge / (4.0 * 0.01 / 0.42), 1e-6);
    EXPECT_GT(held[0].slender, 10.0);
    EXPECT_EQ(paths_of(kBeam)[0].slender, 1.0);
    EXPECT_EQ(paths_of(kSheet + kPins)[0].slender, 1.0);
}

TEST(LoadPaths, OfSolidsThatReachOutBearByBending) {
    const std::string held = kBeam + "pins = { faces = [\"x-\"] }\n";
    const Vec3 down{0.0, -9.81, 0.0};
    const LoadPath path = paths_of(held, false, down)[0];
    // 3/2 density length^3 / (young thickness^2), by the way that goes over diagonals at most.
    const double thickness = 4.0 * 0.01 / 0.42;
    EXPECT_NEAR(path.softness, 1.5 * 20.0 / (1.0e6 * thickness * thickness), 0.03 * path.softness);
    EXPECT_GT(path.firmness, 1.0e6 / (20.0 * 0.1 * 0.1)) << "an edge's own, at least";
    EXPECT_LT(path.firmness, 1.0e8 / (20.0 * 0.1 * 0.1));
    EXPECT_LT(paths_of(held, false, {9.81, 0.0, 0.0})[0].softness, 0.01 * path.softness)
        << "hangs down";
    EXPECT_EQ(paths_of(kBeam, false, down)[0].firmness, 0.0) << "is not held";
    EXPECT_EQ(paths_of(held)[0].firmness, 0.0) << "nothing pulls";
}

/// A strip of hinges a apart is held back from bending by 6 stiffness / (density a^4), but for its
/// ends and diagonals.
TEST(LoadPaths, OfClothMayBearByBending) {
    const Vec3 down{0.0, -9.81, 0.0};
    const LoadPath path = paths_of(kStrip, false, down)[0];
    EXPECT_NEAR(path.softness, 0.1 * 0.95 * 0.95 * 0.95 / 8.0, 0.1 * path.softness);
    const double along = 6.0 / (0.1 * 0.05 * 0.05 * 0.05 * 0.05);
    EXPECT_GT(path.firmness, along);
    EXPECT_LT(path.firmness, 15.0 * along);
    EXPECT_EQ(paths_of(kSheet + kPins, false, down)[0].firmness, 0.0) << "has no bending";
}

}  // namespace
}  // namespace weft::test
