#include "kernels/xpbd/hinges.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>

#include "simulation/mesh/vec3.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

constexpr float kInverseH2 = 1e4f;

Vec3 vec(const float4& v) { return {v.x, v.y, v.z}; }

/// One hinge over four vertices.
struct OneHinge {
    Buffer<float4> positions{"positions", 4};
    Buffer<int> corners{"corners", 4};
    Buffer<float> weights{"weights", 4};
    Buffer<float> multipliers{"multipliers", 1};

    OneHinge(std::array<float4, 4> x, std::array<float, 4> q) {
        for (std::size_t k = 0; k < 4; ++k) {
            positions[k] = x[k];
            corners[k] = static_cast<int>(k);
            weights[k] = q[k];
        }
        multipliers[0] = 7.0f;  // from an earlier substep: not to be used
    }
    void project(int iterations = 1) {
        for (int i = 0; i < iterations; ++i) {
            const Launch one = launch(kernels::project_hinges, Segments{}, positions, corners,
                                      weights, multipliers, 1, kInverseH2, i == 0 ? 1 : 0);
            run_on_host(one, one.kernel->scalar, 0, 1);
        }
    }
    Vec3 bend() const {
        Vec3 sum;
        for (std::size_t k = 0; k < 4; ++k) {
            sum = sum + static_cast<double>(weights[k]) * vec(positions[k]);
        }
        return sum;
    }
};

// Two right triangles over the unit square's diagonal; the weights' shape is exact in float.
const std::array<float4, 4> kSquare{{{0, 0, 0, 1}, {1, 1, 0, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}}};
const std::array<float, 4> kSquareWeights{2.0f, 2.0f, -2.0f, -2.0f};

TEST(Hinges, FlatRestStateIsUntouchedToTheBit) {
    OneHinge hinge(kSquare, kSquareWeights);
    hinge.project(5);
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(std::memcmp(&hinge.positions[k], &kSquare[k], sizeof(float4)), 0);
    }
}

TEST(Hinges, OneIterationSolvesTheImplicitStepOfOneHinge) {
    auto folded = kSquare;
    folded[3].z = 0.5f;
    // Minimum of |x - x~|^2 / (2 h^2) + 1/2 |B|^2: B shrinks by 1/h^2 / (sum w q^2 + 1/h^2).
    const double a = static_cast<double>(kInverseH2);
    for (const int iterations : {1, 20}) {  // the later ones have nothing to add
        OneHinge hinge(folded, kSquareWeights);
        const double before = length(hinge.bend());
        hinge.project(iterations);
        EXPECT_NEAR(length(hinge.bend()), before * a / (16.0 + a), 1e-5);
    }
}

TEST(Hinges, PushAlongMinusTheGradientOfTheirEnergy) {
    // dE/dx_j = q_j B; with 1/h^2 far above the mobility, dx_j = -h^2 w_j q_j B.
    auto folded = kSquare;
    folded[2].z = 0.25f;
    folded[3] = {-0.1f, 1.1f, 0.5f, 3.0f};
    OneHinge hinge(folded, {0.02f, 0.02f, -0.02f, -0.02f});
    const Vec3 bend = hinge.bend();
    hinge.project();
    for (std::size_t k = 0; k < 4; ++k) {
        const double scale = -static_cast<double>(folded[k].w) *
                             static_cast<double>(hinge.weights[k]) /
                             static_cast<double>(kInverseH2);
        const Vec3 moved = vec(hinge.positions[k]) - vec(folded[k]);
        EXPECT_NEAR(moved.z, scale * bend.z, 1e-7) << k;
        EXPECT_NEAR(moved.x, scale * bend.x, 1e-7) << k;
    }
}

TEST(Hinges, ConserveLinearAndAngularMomentum) {
    constexpr std::size_t kCount = 300;
    auto made = make_case("project_hinges", kCount, Flavour::kRandom, 5);
    auto& positions = made->buffer<float4>(0);
    auto& corners = made->buffer<int>(1);
    auto& weights = made->buffer<float>(2);
    for (float4& x : positions.span()) x.w = made->random.real(0.1f, 10.0f);
    for (std::size_t h = 0; h < kCount; ++h) {  // the weights of a hinge sum to 0
        weights[h] = -(weights[h + kCount] + weights[h + 2 * kCount] + weights[h + 3 * kCount]);
    }
    const std::vector<float4> before(positions.span().begin(), positions.span().end());
    run_on_host(made->launch, made->launch.kernel->form(8), 0, made->items);
    for (std::size_t h = 0; h < kCount; ++h) {
        Vec3 linear, angular;
        double flow = 0.0;
        for (std::size_t k = 0; k < 4; ++k) {
            const auto v = static_cast<std::size_t>(corners[h + k * kCount]);
            const Vec3 moved = vec(positions[v]) - vec(before[v]);
            const Vec3 impulse = (1.0 / static_cast<double>(before[v].w)) * moved;
            linear = linear + impulse;
            angular = angular + cross(vec(before[v]), impulse);
            flow += (length(moved) + 0.2) / static_cast<double>(before[v].w);
        }
        EXPECT_LT(length(linear), 3e-6 * flow);
        EXPECT_LT(length(angular), 3e-6 * flow);
    }
}

TEST(Hinges, HeldCornersDoNotMove) {
    auto folded = kSquare;
    folded[3].z = 0.5f;
    for (float4& x : folded) x.w = 0.0f;
    folded[2].w = 2.0f;
    OneHinge hinge(folded, kSquareWeights);
    hinge.project(3);
    for (const std::size_t k : {0, 1, 3}) EXPECT_EQ(vec(hinge.positions[k]), vec(folded[k]));
    EXPECT_NE(hinge.positions[2].z, 0.0f);
}

}  // namespace
}  // namespace weft::test
