// The reference of whole runs against closed forms and against the solvers.
#include "simulation/reference/fine_run.h"
#include "simulation/families/springs/springs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "simulation/families/convert.h"
#include "simulation/simulation.h"
#include "tests/simulation/reference/problems.h"

namespace weft::test {
namespace {

double rms(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        sum += std::pow(static_cast<double>(a[k]) - static_cast<double>(b[k]), 2.0);
    }
    return std::sqrt(3.0 * sum / static_cast<double>(a.size()));
}

std::vector<float> fine(const Scene& scene, int substeps) {
    Warnings warnings;
    Model model(scene, warnings);
    FineRun run(model, substeps);
    for (int frame = 0; frame < scene.frames; ++frame) run.advance();
    return run.positions();
}

/// A single spring between a held vertex and a free one, as two of them side by side: it swings as
/// x(t) = rest + (x0 - rest) cos(omega t).
TEST(FineRun, SpringSwingsAsTheClosedFormSays) {
    Scene scene = parse_scene(kPinnedSheet, "test.toml");
    Cloth& cloth = scene.cloths[0];
    scene.gravity = {};
    scene.dt = 0.1;
    scene.frames = 3;
    cloth.bend.reset();
    cloth.pins.resize(1);
    cloth.pins[0].corners = {"x-z-", "x+z-"};
    cloth.shape = GridShape{{0.1, 1.0}, {2, 2}};
    cloth.stretch.stiffness = 2.0;
    Warnings warnings;
    Model model(scene, warnings);
    // Only the springs along z are to pull.
    const int count = model.find<Springs>()->elements().count();
    for (int s = 0; s < count; ++s) {
        if (std::abs(model.find<Springs>()->rest_length(s) - 1.0) > 1e-3) {
            model.find<Springs>()->material[static_cast<std::size_t>(count + s)] = 1e30f;
        }
    }
    int free = 0;
    for (int v = 0; v < model.vertex_count(); ++v) {
        float4& x = (*model.positions)[static_cast<std::size_t>(v)];
        if (x.w <= 0.0f) continue;
        x.z += 0.25f;
        free = v;
    }
    const double start = static_cast<double>((*model.positions)[static_cast<std::size_t>(free)].z);
    const double omega = std::sqrt(2.0 / model.masses[static_cast<std::size_t>(free)]);
    const double expected = start - 0.25 + 0.25 * std::cos(omega * 0.3);
    const auto error = [&](int substeps) {
        FineRun run(model, substeps);
        for (int frame = 0; frame < 3; ++frame) run.advance();
        const int vertex = model.strips.order[static_cast<std::size_t>(free)];
        return std::abs(
            static_cast<double>(run.positions()[3 * static_cast<std::size_t>(vertex) + 2]) -
            expected);
    };
    EXPECT_LT(error(4000), 2e-4);
    EXPECT_LT(error(8000), 0.6 * error(4000));
}

TEST(FineRun, StableSubstepsAreStable) {
    const Scene scene = parse_scene(kPinnedSheet, "test.toml");
    Warnings warnings;
    const Model model(scene, warnings);
    const int substeps = FineRun::stable_substeps(model);
    EXPECT_LT(rms(fine(scene, substeps), fine(scene, 8 * substeps)), 1e-3);
}

/// Obstacles with friction, damping, moving pins, attachments, solids, membranes: the solvers tend
/// to the same as their steps shrink.
TEST(FineRun, SolversTendToIt) {
    std::string text = kPinnedBlock + R"(
[[obstacle]]
shape = "sphere"
center = [0.1, -0.75, 0.0]
radius = 0.4
friction = 0.3
motion = { velocity = [0.0, 0.2, 0.0] }
)";
    for (const char* method : {"xpbd", "vbd"}) {
        Scene scene = parse_scene(text, "test.toml");
        scene.frames = 6;
        scene.cloths[0].damping = 0.5;
        scene.solids[0].damping = 0.5;
        scene.solver.method = method_named(method);
        scene.solver.iterations = 20;
        Warnings warnings;
        const Model model(scene, warnings);
        const auto reference = fine(scene, 4 * FineRun::stable_substeps(model));
        const auto distance = [&](int substeps) {
            scene.substeps = substeps;
            SimulationOptions options;
            options.devices = "cpu/1";
            Simulation simulation(scene, options, warnings);
            for (int frame = 0; frame < scene.frames; ++frame) simulation.advance();
            return rms(simulation.positions(), reference);
        };
        const double coarse = distance(4);
        const double fine_steps = distance(32);
        EXPECT_LT(fine_steps, 0.3 * coarse) << method;
    }
}

}  // namespace
}  // namespace weft::test
