#include "simulation/solver/halo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "simulation/scene/read_scene.h"

namespace weft::test {
namespace {

/// Two sheets, one of which is long enough for several strips, and a block.
constexpr const char* kScene = R"(
    [scene]
    name = "halo"
    frames = 1
    dt = 0.01
    substeps = 1
    [solver]
    method = "vbd"
    iterations = 1
    [[cloth]]
    grid = { size = [1.0, 4.0], resolution = [20, 80] }
    density = 0.2
    stretch = { stiffness = 1.0e3 }
    bend = { stiffness = 1.0e-4 }
    [[cloth]]
    grid = { size = [1.0, 1.0], resolution = [5, 5] }
    translate = [3.0, 0.0, 0.0]
    density = 0.2
    stretch = { stiffness = 1.0e3 }
    [[solid]]
    grid = { size = [0.1, 0.1, 0.3], resolution = [3, 3, 8] }
    translate = [-3.0, 0.0, 0.0]
    density = 1000.0
    young = 1.0e5
    poisson = 0.3
)";

std::pair<int, int> around(const Model& model, int begin, int end) {
    std::pair<int, int> found{begin, end};
    for (const Stencils& kind : model.stencils()) {
        for (int e = 0; e < kind.count(); ++e) {
            const auto within = [&](int v) { return begin <= v && v < end; };
            if (std::ranges::none_of(kind[e], within)) continue;
            const auto [low, high] = std::ranges::minmax(kind[e]);
            found = {std::min(found.first, low), std::max(found.second, high + 1)};
        }
    }
    return found;
}

TEST(Halo, HasAllThatElementsOfStripsAndSeamsRead) {
    const Model model(parse_scene(kScene, "halo.toml"));
    const Halo halo(model);
    const Strips& strips = model.strips;
    ASSERT_GT(strips.count(), 3);
    for (std::size_t first = 0; first + 1 < strips.begin.size(); ++first) {
        for (std::size_t last = first; last < strips.begin.size(); ++last) {
            const int begin = strips.begin[first], end = strips.begin[last];
            EXPECT_EQ(halo.around(begin, end), around(model, begin, end));
        }
    }
    for (std::size_t first = 0; first < strips.seam_begin.size(); ++first) {
        for (std::size_t last = first; last < strips.seam_end.size(); ++last) {
            const int begin = strips.seam_begin[first], end = strips.seam_end[last];
            EXPECT_EQ(halo.around(begin, end), around(model, begin, end));
        }
    }
}

}  // namespace
}  // namespace weft::test
