#include "kernels/motion.h"

#include <gtest/gtest.h>

#include <cstring>

#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

constexpr float kH = 1.0f / 600.0f;
constexpr std::size_t kCount = 50;

struct Particles {
    Buffer<float4> positions{"positions", kCount};
    Buffer<float4> previous{"previous", kCount};
    Buffer<float4> velocities{"velocities", kCount};
    Buffer<float4> gravity{"gravity", 2};

    explicit Particles(unsigned seed) {
        Random random(seed);
        for (std::size_t v = 0; v < kCount; ++v) {
            positions[v] = random.point(1.0f);
            positions[v].w = v % 5 == 0 ? 0.0f : 2.0f;
            velocities[v] = random.point(3.0f);
            velocities[v].w = 0.9f;
        }
        gravity[1] = {1.0f, -9.81f, 0.5f, 0.0f};
    }
    void predict() {
        run(launch(kernels::predict, Segments{}, positions, previous, velocities, gravity, kH,
                   kInstance));
    }
    void update() {
        run(launch(kernels::update_velocities, Segments{}, positions, previous, velocities, gravity,
                   kH, 1.0f / kH, kInstance));
    }
    void update_damped() {
        run(launch(kernels::update_damped_velocities, Segments{}, positions, previous, velocities,
                   gravity, kH, 1.0f / kH, kInstance));
    }

private:
    static void run(const Launch& launch) {
        run_on_host(launch, launch.kernel->form(8), 0, kCount, 1);
    }
};

float falling(float v, float g) { return v + kH * g; }

TEST(Motion, PredictMovesFreeVerticesByTheirNewVelocity) {
    Particles p(1);
    const Particles before(1);
    p.predict();
    for (std::size_t v = 0; v < kCount; ++v) {
        EXPECT_EQ(std::memcmp(&p.previous[v], &before.positions[v], sizeof(float4)), 0);
        const float moved = v % 5 == 0 ? 0.0f : falling(before.velocities[v].y, -9.81f) * kH;
        EXPECT_EQ(p.positions[v].y, before.positions[v].y + moved);
        EXPECT_EQ(p.positions[v].w, before.positions[v].w);
    }
}

TEST(Motion, FreeFallIsExactToTheBit) {
    Particles p(2);
    const Particles before(2);
    p.predict();
    p.update();  // nothing was solved in between
    for (std::size_t v = 0; v < kCount; ++v) {
        EXPECT_EQ(p.velocities[v].x, v % 5 == 0 ? 0.0f : falling(before.velocities[v].x, 1.0f));
        EXPECT_EQ(p.velocities[v].w, 0.9f);
    }
}

TEST(Motion, DampingLeavesItsPartOfTheVelocity) {
    Particles p(3);
    const Particles before(3);
    p.predict();
    p.update_damped();
    for (std::size_t v = 0; v < kCount; ++v) {
        EXPECT_EQ(p.velocities[v].z,
                  v % 5 == 0 ? 0.0f : falling(before.velocities[v].z, 0.5f) * 0.9f);
    }
}

TEST(Motion, WhatTheSolverMovedBecomesVelocity) {
    Particles p(4);
    const Particles before(4);
    p.predict();
    for (float4& x : p.positions.span()) x.y += 0.125f;
    p.update();
    const float expected = falling(before.velocities[1].y, -9.81f) + 0.125f / kH;
    EXPECT_NEAR(p.velocities[1].y, expected, 1e-4f * expected);
    EXPECT_EQ(p.velocities[0].y, 0.0f) << "a held vertex has no velocity";
}

TEST(Motion, PinsAreCarriedByTheirGroupsMap) {
    Buffer<float4> positions("positions", 4);
    Buffer<int> vertices("vertices", 2);
    Buffer<float4> rest("rest", 2);
    Buffer<float4> motions("motions", 2 * 2 * 3);
    vertices[0] = 3;
    vertices[1] = 1;
    rest[0] = {1.0f, 2.0f, 3.0f, 0.0f};
    rest[1] = {0.0f, 0.0f, 1.0f, 0.0f};
    float4* rows = motions.data() + 3 * (1 * 2 + 1);  // substep 1, group 1: a quarter turn about y
    rows[0] = {0.0f, 0.0f, 1.0f, 10.0f};
    rows[1] = {0.0f, 1.0f, 0.0f, 0.0f};
    rows[2] = {-1.0f, 0.0f, 0.0f, 0.5f};
    const Launch move =
        launch(kernels::move_pins, Segments{}, positions, vertices, rest, motions, 2, 1, kInstance);
    run_on_host(move, move.kernel->form(8), 0, 2, 1);
    EXPECT_EQ(positions[3].x, 13.0f);
    EXPECT_EQ(positions[3].y, 2.0f);
    EXPECT_EQ(positions[3].z, -0.5f);
    EXPECT_EQ(positions[1].x, 11.0f);
    EXPECT_EQ(positions[0].x, 0.0f) << "no pin";
}

}  // namespace
}  // namespace weft::test
