// Bodies that hang from where they are held: they swing as physics says however few iterations
// there are, and what is held stays where it is.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>

#include "simulation/families/convert.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

std::vector<float4> copy_of(const Buffer<float4>& buffer) {
    const auto values = buffer.span();
    return {values.begin(), values.end()};
}

class Swinging : public EverySolver {
protected:
    /// A stiff sheet of 0.5 m that comes down from where it is held.
    static Scene hung(const std::string& pins, int iterations) {
        Scene scene = scene_of(fmt::format(R"(
[scene]
frames = 1
dt = 0.016666667
substeps = 8
[solver]
iterations = {}
[[cloth]]
grid = {{ size = [0.5, 0.5], resolution = [15, 15] }}
density = 0.5
stretch = {{ stiffness = 2.0e4 }}
bend = {{ stiffness = 1.0e-4 }}
{}
)",
                                           iterations, pins));
        return scene;
    }

    static Scene solved(Scene scene) {
        scene.solver.method = Method::kNewton;
        scene.solver.iterations = 10;
        return scene;
    }
};

const std::string kCorners = "pins = [ { corners = [\"x-z-\", \"x+z-\"] } ]";
const std::string kCorner = "pins = [ { corners = [\"x-z-\"] } ]";
const std::string kEdge = "pins = [ { edges = [\"z-\"] } ]";
const std::string kTurned =
    "pins = [ { corners = [\"x-z-\", \"x+z-\"], motion = { angular_velocity = 90.0 } } ]";

/// With four iterations, vbd, sosd and jpgd had come down by less than half as far.
TEST_P(Swinging, ComesDownAsIfItWereSolved) {
    for (const std::string& pins : {kCorners, kCorner, kEdge, kTurned}) {
        ManualRun run(hung(pins, 4)), solved_run(solved(hung(pins, 4)));
        const Momentum start = momentum_of(run, 0);
        for (int frame = 0; frame < 18; ++frame) {
            run.run(1);
            solved_run.run(1);
            const Vec3 expected = momentum_of(solved_run, 0).place - start.place;
            const Vec3 found = momentum_of(run, 0).place - start.place;
            EXPECT_LT(length(found - expected), 0.01 + 0.1 * length(expected))
                << pins << ", frame " << frame;
        }
        EXPECT_LT(momentum_of(run, 0).place.y, start.place.y - 0.15) << pins;
    }
}

/// What is held is exactly where it would be without a sheet.
TEST_P(Swinging, LeavesWhatIsHeld) {
    ManualRun run(hung(kEdge, 4));
    const std::vector<float4> before = copy_of(*run.model->positions);
    run.run(5);
    int held = 0;
    for (std::size_t v = 0; v < before.size(); ++v) {
        if (before[v].w > 0.0f) continue;
        const float4& now = (*run.model->positions)[v];
        EXPECT_TRUE(now.x == before[v].x && now.y == before[v].y && now.z == before[v].z);
        ++held;
    }
    EXPECT_EQ(held, 15);
}

/// What a sheet that hangs at rest by four corners weighs has nowhere to swing to.
TEST_P(Swinging, LeavesWhatCannot) {
    const std::string pins = "pins = [ { corners = [\"x-z-\", \"x+z-\", \"x-z+\", \"x+z+\"] } ]";
    ManualRun run(hung(pins, 8)), solved_run(solved(hung(pins, 8)));
    run.run(30);
    solved_run.run(30);
    EXPECT_LT(length(momentum_of(run, 0).place - momentum_of(solved_run, 0).place), 0.01);
}

/// Not by xpbd, whose corrections keep angular momentum about where each of them is made.
class SwingingExactly : public Swinging {};

/// As in a step of implicit Euler that is solved, sum m r x (v_(n+1) - v_n - h g) = 0 about a line
/// or a point that what is held cannot turn it about.
TEST_P(SwingingExactly, LacksNoAngularMomentum) {
    for (const std::string& pins : {kCorners, kCorner, kTurned}) {
        Scene scene = hung(pins, 2);
        scene.substeps = 1;
        scene.dt = 0.002;
        ManualRun run(scene);
        for (int frame = 0; frame < 40; ++frame) {
            const std::vector<float4> before = copy_of(*run.model->velocities);
            run.run(1);
            std::vector<Vec3> held;
            for (const float4& x : run.model->positions->span()) {
                if (x.w <= 0.0f) held.push_back(to_vec3(x));
            }
            Vec3 sum;
            double size = 0.0;
            for (std::size_t v = 0; v < before.size(); ++v) {
                const float4& x = (*run.model->positions)[v];
                if (x.w <= 0.0f) continue;
                const Vec3 lever = to_vec3(x) - held[0];
                const Vec3 change = to_vec3((*run.model->velocities)[v]) - to_vec3(before[v]) -
                                    scene.dt * scene.gravity;
                sum = sum + run.model->masses[v] * cross(lever, change);
                size += run.model->masses[v] * length(lever) * length(change);
            }
            const Vec3 line = held.back() - held[0];
            const double missing =
                held.size() > 1 ? std::abs(dot(sum, line)) / length(line) : length(sum);
            EXPECT_LT(missing, 0.01 * size) << pins << ", frame " << frame;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, Swinging,
                         testing::Values(Method::kVbd, Method::kSosd, Method::kJpgd,
                                         Method::kNewton),
                         name_of_method);
INSTANTIATE_TEST_SUITE_P(Methods, SwingingExactly,
                         testing::Values(Method::kVbd, Method::kSosd, Method::kJpgd),
                         name_of_method);

}  // namespace
}  // namespace weft::test
