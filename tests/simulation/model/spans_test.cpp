#include "simulation/model/spans.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "simulation/scene/read_scene.h"

namespace weft::test {
namespace {

constexpr Vec3 kDown{0.0, -9.81, 0.0};

const std::string kScene = R"(
[scene]
frames = 1
dt = 0.02
[[cloth]]
name = "sheet"
grid = { size = [1.0, 0.6], resolution = [21, 13] }
density = 0.2
)";
const std::string kSprings = "stretch = { stiffness = 500.0 }\n";
const std::string kBothEnds = "pins = { edges = [\"x-\", \"x+\"] }\n";

LoadPath path_of(const std::string& text, Vec3 gravity = kDown) {
    Warnings warnings;
    const Gathered all = gather(parse_scene(text, "test.toml"), warnings);
    const auto paths = load_paths(all, {}, gravity);
    EXPECT_EQ(paths.size(), 1U);
    return paths[0];
}

double span_by(const std::string& pins) { return path_of(kScene + kSprings + pins).span; }

TEST(Spans, RunBetweenOppositeSides) {
    const LoadPath path = path_of(kScene + kSprings + kBothEnds);
    EXPECT_NEAR(path.span, 1.0, 0.03) << "straight, or nearly";
    EXPECT_NEAR(path.slack, 0.0, 1e-9);
    EXPECT_NEAR(path.pull, 1.0, 1e-9);
    EXPECT_NEAR(path.stride, 0.05, 1e-3);
    EXPECT_NEAR(span_by("pins = { edges = [\"x-\", \"x+\", \"z-\", \"z+\"] }\n"), 0.6, 0.03);
    EXPECT_NEAR(span_by("pins = { edges = [\"x-\", \"z-\", \"z+\"] }\n"), 0.6, 0.03);
    const double diagonal = std::sqrt(1.36);
    EXPECT_NEAR(span_by("pins = { corners = [\"x-z-\", \"x+z+\"] }\n"), diagonal, 1e-9);
    EXPECT_NEAR(span_by("pins = { corners = [\"x-z-\", \"x+z-\", \"x-z+\", \"x+z+\"] }\n"),
                diagonal, 1e-9);
    const std::string lines =
        "pins = { box = [[[-1, -1, -1], [-0.49, 1, 1]], [[-0.01, -1, -1], [0.01, 1, 1]], "
        "[[0.49, -1, -1], [1, 1, 1]]] }\n";
    EXPECT_NEAR(span_by(lines), 0.5, 0.02) << "two of them, side by side";
}

TEST(Spans, AreNotOfWhatHangsFromOneSide) {
    EXPECT_EQ(span_by(""), 0.0);
    EXPECT_EQ(span_by("pins = { edges = [\"x-\"] }\n"), 0.0);
    EXPECT_EQ(span_by("pins = { edges = [\"x-\", \"z-\"] }\n"), 0.0);
    EXPECT_EQ(span_by("pins = { corners = [\"x-z-\"] }\n"), 0.0);
    EXPECT_EQ(span_by("pins = { corners = [\"x-z-\", \"x+z-\"] }\n"), 0.0);
    EXPECT_EQ(span_by("pins = { corners = [\"x-z-\", \"x-z+\"] }\n"), 0.0);
    EXPECT_EQ(span_by("pins = { box = [[-0.11, -1, -0.11], [0.11, 1, 0.11]] }\n"), 0.0)
        << "over a small table";
    EXPECT_EQ(path_of(kScene + kSprings + kBothEnds, {}).span, 0.0) << "nothing pulls";
}

/// They may come nearer at any time.
TEST(Spans, AreNotBetweenPinsThatMove) {
    EXPECT_EQ(span_by("pins = [{ edges = [\"x-\"] }, { edges = [\"x+\"], "
                      "motion = { velocity = [-0.1, 0.0, 0.0] } }]\n"),
              0.0);
}

/// Only what of gravity is across them, and all that hangs on the cloth.
TEST(Spans, ArePulledAcross) {
    const std::string scene = kScene + kSprings + kBothEnds;
    EXPECT_NEAR(path_of(scene, {0.0, -3.0, 4.0}).pull, 0.6, 1e-9);
    EXPECT_NEAR(path_of(scene + "rotate = [1.0, 0.0, 0.0, 30.0]\n").pull, std::sqrt(0.75), 1e-6);
    EXPECT_NEAR(path_of(scene + "rotate = [1.0, 0.0, 0.0, 90.0]\n").pull, 0.0, 1e-6) << "upright";
    EXPECT_NEAR(path_of(scene + "rotate = [0.0, 0.0, 1.0, 30.0]\n").pull, std::sqrt(0.75), 1e-6)
        << "a slope";
}

/// The square of the speed is stiffness over density, per width.
TEST(Spans, HaveWavesAsFastAsTheirMaterialIsStiff) {
    const auto squared = [](const std::string& material, const std::string& more = "") {
        const double wave = path_of(kScene + material + kBothEnds + more).wave;
        return wave * wave;
    };
    // One along, half a one along by the diagonal, of each cell.
    EXPECT_NEAR(squared(kSprings), 1.5 * 500.0 / 0.2, 0.1 * 500.0 / 0.2);
    const std::string membrane =
        "membrane = { young = 1.0e6, poisson = 0.3, thickness = 1.0e-3 }\n";
    EXPECT_NEAR(squared(membrane), 1000.0 / (1.0 - 0.09) / 0.2, 1.0);
    const auto woven = [](const std::string& direction) {
        return "woven = { warp = 400.0, weft = 800.0, shear = 30.0, direction = " + direction +
               " }\n";
    };
    EXPECT_NEAR(squared(woven("[1.0, 0.0, 0.0]")), 2000.0, 1e-3);
    EXPECT_NEAR(squared(woven("[0.0, 0.0, 1.0]")), 4000.0, 1e-3);
    EXPECT_NEAR(squared(woven("[1.0, 0.0, 1.0]")), 0.25 * 6000.0 + 150.0, 1e-3);
    const std::string turning = "woven = { warp = 400.0, weft = 800.0, shear = 30.0 }\n";
    EXPECT_NEAR(squared(turning, "rotate = [0.3, 1.0, 0.2, 40.0]\n"), 2000.0, 1e-3)
        << "turns with the cloth";
    EXPECT_NEAR(squared(kSprings + membrane), squared(kSprings) + squared(membrane), 1e-6);
}

/// An arc of 2 rad between its ends, of triangles that face up and down by turns.
std::string arc() {
    constexpr int kCells = 40;
    const std::string path =
        (std::filesystem::temp_directory_path() / "weft_arc_of_spans.obj").string();
    std::ofstream file(path);
    for (int i = 0; i <= kCells; ++i) {
        const double angle = 2.0 * i / kCells - 1.0;
        for (const double z : {0.0, 0.05, 0.1, 0.15}) {
            file << "v " << std::sin(angle) << ' ' << -std::cos(angle) << ' ' << z << '\n';
        }
    }
    for (int i = 0; i < kCells; ++i) {
        for (int k = 1; k < 4; ++k) {
            const int a = 4 * i + k;
            file << "f " << a << ' ' << a + 1 << ' ' << a + 4 << '\n';
            file << "f " << a + 1 << ' ' << a + 4 << ' ' << a + 5 << '\n';
        }
    }
    return path;
}

/// It hangs loose by as much as its way along the surface is longer.
TEST(Spans, KnowTheSlackOfWhatHangsInACurve) {
    std::string text = kScene + kSprings;
    const auto from = text.find("grid");
    text.replace(from, text.find('\n', from) - from, "mesh = \"" + arc() + "\"");
    const double end = std::cos(1.0) - 1e-3;
    const LoadPath path = path_of(text + "pins = { box = [[-2, " + std::to_string(-end - 2e-3) +
                                  ", -1], [2, 1, 1]] }\n");
    EXPECT_NEAR(path.span, 2.0 * std::sin(1.0), 0.02);
    EXPECT_NEAR(path.slack, 1.0 / std::sin(1.0) - 1.0, 2e-3);
}

TEST(Spans, OfManyVerticesAreTheWidestOfAll) {
    const std::vector<Vec3> rest{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {5, 0, 0}, {4, 0, 0}};
    const auto widest = [&](const std::vector<int>& held, const std::vector<int>& loose) {
        return length(widest_span(rest, held, loose, {0, -1, 0}));
    };
    EXPECT_EQ(widest({0, 2, 4}, {1}), 2.0);
    EXPECT_EQ(widest({0, 2, 4}, {1, 3}), 3.0);
    EXPECT_EQ(widest({0, 2}, {4, 5}), 0.0);
}

}  // namespace
}  // namespace weft::test
