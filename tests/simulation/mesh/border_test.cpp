#include "simulation/mesh/border.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "simulation/mesh/generators.h"

namespace weft {
namespace {

TEST(Border, OfAGridIsOneLoop) {
    const TriangleMesh grid = make_grid({1.0, 1.0}, {3, 3});
    const auto chains = border_chains(grid, std::vector<char>(9, 1));
    ASSERT_EQ(chains.size(), 1U);
    EXPECT_TRUE(chains[0].is_closed);
    EXPECT_EQ(chains[0].vertices.size(), 8U);
    for (std::size_t i = 0; i < 8; ++i) {
        const Vec3 a = grid.positions[static_cast<std::size_t>(chains[0].vertices[i])];
        const Vec3 b = grid.positions[static_cast<std::size_t>(chains[0].vertices[(i + 1) % 8])];
        EXPECT_NEAR(length(a - b), 0.5, 1e-12) << "neighbours";
    }
}

TEST(Border, SelectedPiecesAreChains) {
    const TriangleMesh grid = make_grid({1.0, 1.0}, {4, 3});
    std::vector<char> selected(12, 0);
    for (const int v : {0, 1, 2, 3, 8, 9, 5}) selected[static_cast<std::size_t>(v)] = 1;
    auto chains = border_chains(grid, selected);
    ASSERT_EQ(chains.size(), 2U);  // vertex 5 lies inside
    for (BorderChain& chain : chains) {
        EXPECT_FALSE(chain.is_closed);
        if (chain.vertices.front() > chain.vertices.back()) {
            std::reverse(chain.vertices.begin(), chain.vertices.end());
        }
    }
    if (chains[0].vertices.size() < chains[1].vertices.size()) std::swap(chains[0], chains[1]);
    EXPECT_EQ(chains[0].vertices, (std::vector{0, 1, 2, 3}));
    EXPECT_EQ(chains[1].vertices, (std::vector{8, 9}));
}

TEST(Border, RimsOfATubeAreLoops) {
    const TriangleMesh tube = make_cylinder({1.0, 1.0}, 1.0, {6, 3});
    const auto chains = border_chains(tube, std::vector<char>(18, 1));
    ASSERT_EQ(chains.size(), 2U);
    for (const BorderChain& chain : chains) {
        EXPECT_TRUE(chain.is_closed);
        EXPECT_EQ(chain.vertices.size(), 6U);
    }
    EXPECT_TRUE(border_chains(tube, std::vector<char>(18, 0)).empty());
}

}  // namespace
}  // namespace weft
