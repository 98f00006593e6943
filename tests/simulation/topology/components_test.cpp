#include "simulation/topology/components.h"

#include <gtest/gtest.h>

namespace weft::test {
namespace {

TEST(Components, OfNothingAreNone) { EXPECT_EQ(component_begins(0, {}), std::vector<int>{0}); }

TEST(Components, VerticesWithoutElementsAreOneEach) {
    EXPECT_EQ(component_begins(3, {}), (std::vector<int>{0, 1, 2, 3}));
}

TEST(Components, HangTogetherByElementsOfAnyKind) {
    const std::vector<Stencils> kinds{{2, {0, 1, 5, 4}}, {3, {2, 1, 0, 7, 5, 6}}};
    EXPECT_EQ(component_begins(9, kinds), (std::vector<int>{0, 3, 4, 8, 9}));
}

}  // namespace
}  // namespace weft::test
