// What runs hold per vertex: all that they have allocated, buffers included. A large scene has
// little else, so what grows here is missing there (docs/measurements.md).

#include <gtest/gtest.h>

#include <string>

#include "runtime/buffer.h"
#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"

#ifdef __GLIBC__
#if __GLIBC_PREREQ(2, 33)
#include <malloc.h>
#define WEFT_HAS_MALLINFO
#endif
#endif

namespace weft::test {
namespace {

/// Allocated and not freed [B]; 0: this system does not tell.
double allocated() {
#ifdef WEFT_HAS_MALLINFO
    const auto info = ::mallinfo2();
    return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
#else
    return 0.0;
#endif
}

/// Springs and bending, side x side vertices. The frame before the last one has no estimate.
Scene sheet(const std::string& method, int side) {
    const std::string resolution = std::to_string(side);
    Scene scene = parse_scene(R"(
        [scene]
        name = "sheet"
        frames = 3
        dt = 0.01
        substeps = 1
        gravity = [0.0, -9.81, 0.0]
        [solver]
        method = ")" + method + R"("
        iterations = 1
        [[cloth]]
        name = "sheet"
        grid = { size = [1.0, 1.0], resolution = [)" +
                                  resolution + ", " + resolution + R"(] }
        density = 0.2
        stretch = { stiffness = 1.0e3 }
        bend = { stiffness = 1.0e-4 }
        pins = { corners = ["x-z-", "x+z-"] }
    )",
                              "sheet.toml");
    return scene;
}

struct Held {
    double run;       ///< [B] by a run before its first estimate,
    double estimate;  ///< and what it holds more from then on
};

Held held_at(const std::string& method, int side) {
    SimulationOptions options;
    options.devices = "cpu/1";
    options.calibrate = false;
    options.on_trouble = OnTrouble::kReport;
    Warnings warnings;
    const double before = allocated();
    Simulation simulation(sheet(method, side), options, warnings);
    simulation.advance();
    simulation.advance();
    const double run = allocated();
    simulation.advance();
    return {run - before, allocated() - run};
}

/// Per vertex: what a larger sheet has more than a smaller one. Small enough that no buffer has
/// pages of its own, which malloc does not count.
Held held_per_vertex(const std::string& method) {
    constexpr int kSmall = 60, kLarge = 160;
    constexpr double kMore = kLarge * kLarge - kSmall * kSmall;
    held_at(method, kSmall);  // what stays for ever
    const Held small = held_at(method, kSmall);
    const Held large = held_at(method, kLarge);
    return {(large.run - small.run) / kMore, (large.estimate - small.estimate) / kMore};
}

/// A few per cent above what was measured.
struct Limits {
    const char* method;
    double run, estimate;  ///< [B] per vertex
};

class MemoryUse : public testing::TestWithParam<Limits> {};

TEST_P(MemoryUse, PerVertexIsBounded) {
    const double before = allocated();
    const Buffer<int> known("known", 1 << 14);
    if (allocated() - before < static_cast<double>(known.bytes())) {
        GTEST_SKIP() << "the allocator does not tell";
    }
    const Held held = held_per_vertex(GetParam().method);
    EXPECT_LE(held.run, GetParam().run);
    EXPECT_LE(held.estimate, GetParam().estimate);
    // Far less has not been measured, but missed.
    EXPECT_GE(held.run, 0.5 * GetParam().run);
    EXPECT_GE(held.estimate, 0.5 * GetParam().estimate);
}

INSTANTIATE_TEST_SUITE_P(Methods, MemoryUse,
                         testing::Values(Limits{"xpbd", 335.0, 1140.0},
                                         Limits{"vbd", 590.0, 1140.0}),
                         [](const auto& limits) { return std::string(limits.param.method); });

}  // namespace
}  // namespace weft::test
