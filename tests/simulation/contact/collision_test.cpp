// Bodies that collide: momentum and angular momentum against what mechanics says.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "simulation/families/convert.h"
#include "tests/simulation/contact/blocks.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

class Colliding : public EverySolver {};

/// Two blocks that meet at 1 m/s each, the second one of so many times the mass of the first.
std::string meeting_blocks(int iterations, int substeps, double ratio) {
    return head(iterations, "", "gravity = [0, 0, 0]", substeps) +
           block("a", {-0.06, 0, 0}, 200.0, 2e5, 0) +
           block("b", {0.06, 0.003, 0.002}, 200.0 * ratio, 2e5, 0);
}

void start_meeting(ManualRun& run, Vec3 velocity) {
    for (std::size_t v = 0; v < run.model->velocities->count(); ++v) {
        const Vec3 own = (body_of(run, static_cast<int>(v)) == 0 ? 1.0 : -1.0) * velocity;
        float4& u = (*run.model->velocities)[v];
        u = {static_cast<float>(own.x), static_cast<float>(own.y), static_cast<float>(own.z), u.w};
    }
    run.changed(*run.model->velocities);
}

/// How far the momentum of both is ever off, in parts of the first one's at the start.
double momentum_lost(ManualRun& run) {
    start_meeting(run, {1.0, 0.0, 0.0});
    const double ratio = momentum_of(run, 1).mass / momentum_of(run, 0).mass;
    const Vec3 start{1.0 - ratio, 0.0, 0.0};
    double most = 0.0;
    for (int frame = 0; frame < 12; ++frame) {
        run.run(1);
        const Vec3 now = momentum_of(run, 0).velocity + ratio * momentum_of(run, 1).velocity;
        most = std::max(most, length(now - start));
    }
    return most;
}

TEST_P(Colliding, HeadOnCollisionsKeepMomentum) {
    for (const int iterations : {2, 8}) {
        ManualRun run(scene_of(meeting_blocks(iterations, 10, 1.0)));
        EXPECT_LT(momentum_lost(run), 1e-5) << iterations << " iterations";
        EXPECT_LT(momentum_of(run, 0).velocity.x, -0.1) << "they part";
    }
}

/// About the origin, of both, in parts of what one of them has.
Vec3 angular_momentum(const ManualRun& run) {
    Vec3 sum;
    for (std::size_t v = 0; v < run.model->masses.size(); ++v) {
        const Vec3 p = run.model->masses[v] * to_vec3((*run.model->velocities)[v]);
        sum = sum + cross(to_vec3((*run.model->positions)[v]), p);
    }
    return sum;
}

std::string glancing_blocks(int iterations) {
    return head(iterations, "", "gravity = [0, 0, 0]") +
           block("a", {-0.06, 0.0, 0.0}, 200.0, 2e5, 0) +
           block("b", {0.06, 0.06, 0.03}, 200.0, 2e5, 0);
}

/// Blocks that meet off their centres, and turn each other.
TEST_P(Colliding, OffCentreCollisionsKeepAngularMomentum) {
    for (const int iterations : {2, 8}) {
        ManualRun run(scene_of(glancing_blocks(iterations)));
        start_meeting(run, {1.0, 0.0, 0.0});
        const Vec3 start = angular_momentum(run);
        const double size = length(start);
        double most = 0.0;
        for (int frame = 0; frame < 12; ++frame) {
            run.run(1);
            most = std::max(most, length(angular_momentum(run) - start) / size);
        }
        EXPECT_LT(most, 0.05) << iterations << " iterations";
        EXPECT_LT(momentum_of(run, 0).velocity.x, 0.9) << "they meet";
    }
}

/// No axis is another one's better: bodies in contact are shifted and turned alike in all places.
TEST_P(Colliding, TurnedCollisionsGiveTheTurnedResult) {
    const auto run_turned = [](double degrees) {
        const Vec3 axis{1.0, 2.0, -1.0};
        Scene scene = scene_of(glancing_blocks(8));
        for (auto& solid : scene.solids) {
            solid.transform.rotations.push_back({axis, degrees});
            solid.transform.translate = rotation_matrix(axis, degrees) * solid.transform.translate;
        }
        ManualRun run(scene);
        start_meeting(run, rotation_matrix(axis, degrees) * Vec3{1.0, 0.0, 0.0});
        run.run(12);
        return turned_back(positions(run), axis, degrees);
    };
    EXPECT_LT(difference(run_turned(0.0), run_turned(40.0)), 1e-3);
}

TEST_P(Colliding, HeavyOnesKeepMomentumToo) {
    for (const double ratio : {10.0, 100.0}) {
        for (const int iterations : {2, 8}) {
            ManualRun run(scene_of(meeting_blocks(iterations, 10, ratio)));
            EXPECT_LT(momentum_lost(run), 2e-4)
                << "1 : " << ratio << ", " << iterations << " iterations";
            EXPECT_LT(momentum_of(run, 0).velocity.x, -1.0) << "the light one turns round";
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, Colliding,
                         testing::Values(Method::kVbd, Method::kSosd, Method::kJpgd, Method::kXpbd),
                         name_of_method);

}  // namespace
}  // namespace weft::test
