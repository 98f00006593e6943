// Runs against closed forms that hold whatever the solver's pass order is.

#include <gtest/gtest.h>

#include <cmath>

#include "simulation/families/convert.h"
#include "simulation/families/springs/springs.h"
#include "simulation/scene/read_scene.h"
#include "tests/simulation/run/manual_run.h"

namespace weft::test {
namespace {

const std::string kSheet = R"(
[scene]
frames = 1
dt = 0.016
substeps = 8
[solver]
method = "xpbd"
iterations = 4
[[cloth]]
grid = { size = [1.0, 1.0], resolution = [12, 14] }
density = 0.2
stretch = { stiffness = 1.0e3 }
bend = { stiffness = 1.0e-3 }
)";

/// Springs of no stiffness are as good as none: so a sheet becomes chains along y.
void cut_all_springs_but_upright_ones(ManualRun& run) {
    Springs& springs = *run.model->find<Springs>();
    const int count = springs.count();
    for (int s = 0; s < count; ++s) {
        const auto ends = springs.corners(s);
        const Vec3 along = to_vec3((*run.model->positions)[static_cast<std::size_t>(ends[0])]) -
                           to_vec3((*run.model->positions)[static_cast<std::size_t>(ends[1])]);
        if (std::abs(along.y) > 0.99 * length(along)) continue;
        springs.material[static_cast<std::size_t>(count + s)] = 1e30f;
    }
    run.changed(springs.material);
}

/// Every spring of a chain at rest is stretched by the weight below it over its stiffness.
TEST(Chain, HangsAsLongAsTheClosedFormSays) {
    constexpr int kLength = 9;
    constexpr double kStiffness = 20.0;
    Scene scene = parse_scene(kSheet, "test.toml");
    scene.solver.iterations = 20;
    Cloth& cloth = scene.cloths[0];
    cloth.shape = GridShape{{0.1, 0.8}, {2, kLength}};
    cloth.stretch.stiffness = kStiffness;
    cloth.bend.reset();
    cloth.damping = 4.0;
    cloth.transform.rotations = {{{1.0, 0.0, 0.0}, 90.0}};
    cloth.pins.emplace_back().vertices = {0, 1};
    ManualRun run(scene);
    cut_all_springs_but_upright_ones(run);
    run.run(400);

    const Model& model = *run.model;
    for (int side = 0; side < 2; ++side) {
        const auto rank = [&](int row) {
            return static_cast<std::size_t>(
                model.strips.rank[static_cast<std::size_t>(2 * row + side)]);
        };
        double weight = 0.0;
        for (int row = kLength - 1; row > 0; --row) {
            weight += 9.81 * model.masses[rank(row)];
            const float extent =
                (*model.positions)[rank(row - 1)].y - (*model.positions)[rank(row)].y;
            EXPECT_NEAR(static_cast<double>(extent) - 0.1, weight / kStiffness,
                        2e-3 * weight / kStiffness)
                << "above row " << row;
        }
    }
}

struct Momenta {
    Vec3 linear, angular;
    double size = 0.0;  ///< the sum of all sizes
};

Momenta momenta_of(const ManualRun& run) {
    Momenta sum;
    for (std::size_t v = 0; v < run.model->positions->count(); ++v) {
        const Vec3 p = run.model->masses[v] * to_vec3((*run.model->velocities)[v]);
        sum.linear = sum.linear + p;
        sum.angular = sum.angular + cross(to_vec3((*run.model->positions)[v]), p);
        sum.size += length(p);
    }
    return sum;
}

/// A sheet, stretched, bent and sheared without symmetry by a good part of its size, is let go.
Momenta momenta_after_release(int substeps) {
    Scene scene = parse_scene(kSheet, "test.toml");
    scene.gravity = {};
    scene.substeps = substeps;
    ManualRun run(scene);
    auto& x = *run.model->positions;
    for (std::size_t v = 0; v < x.count(); ++v) {
        x[v] = {1.3f * x[v].x + 0.2f * x[v].z, 0.4f * x[v].x * x[v].x + 0.1f * x[v].z,
                0.8f * x[v].z + 0.2f * x[v].x * x[v].z, x[v].w};
    }
    run.changed(x);
    run.run(4);
    return momenta_of(run);
}

/// Every correction moves its vertices' centre of mass by nothing: this holds to rounding.
TEST(Momentum, LinearIsConservedAtAnyDeformation) {
    for (const int substeps : {8, 64}) {
        const Momenta momenta = momenta_after_release(substeps);
        EXPECT_GT(momenta.size, 0.1) << "it moves";
        EXPECT_LT(length(momenta.linear), 1e-4 * momenta.size);
    }
}

/// A step's impulses are internal to the positions at its end, but the moment of momentum is taken
/// about those at its beginning: implicit Euler changes it by h^2 sum f x v per step, XPBD's passes
/// likewise. So it drifts, by a few percent of all momenta here, and the drift goes with h.
TEST(Momentum, AngularDriftsInProportionToTheStep) {
    const auto drift = [](int substeps) {
        const Momenta momenta = momenta_after_release(substeps);
        return length(momenta.angular) / momenta.size;
    };
    const double coarse = drift(64);
    const double middle = drift(256);
    const double fine = drift(1024);
    EXPECT_GT(fine, 1e-4) << "large enough to compare";
    EXPECT_NEAR(coarse / middle, 4.0, 0.6);
    EXPECT_NEAR(middle / fine, 4.0, 0.6);
}

}  // namespace
}  // namespace weft::test
