#include "kernels/xpbd/springs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "simulation/mesh/vec3.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

constexpr float kInverseH2 = 1e4f;

Vec3 vec(const float4& v) { return {v.x, v.y, v.z}; }

/// One spring between two vertices, projected `iterations` times.
struct OneSpring {
    Buffer<float4> positions{"positions", 2};
    Buffer<int> ends{"ends", 2};
    Buffer<float> material{"material", 2};
    Buffer<float> multipliers{"multipliers", 1};

    OneSpring(float4 x0, float4 x1, float rest_length, float compliance) {
        positions[0] = x0;
        positions[1] = x1;
        ends[1] = 1;
        material[0] = rest_length;
        material[1] = compliance;
        multipliers[0] = 7.0f;  // from an earlier substep: not to be used
    }
    void project(int iterations = 1) {
        for (int i = 0; i < iterations; ++i) {
            const Launch one = launch(kernels::project_springs, Segments{}, positions, ends,
                                      material, multipliers, 1, kInverseH2, i == 0 ? 1 : 0);
            run_on_host(one, one.kernel->scalar, 0, 1);
        }
    }
    double length() const { return weft::length(vec(positions[0]) - vec(positions[1])); }
};

TEST(Springs, StiffOneReturnsToItsRestLengthByMasses) {
    OneSpring spring({0, 0, 0, 1.0f}, {3, 4, 0, 3.0f}, 2.5f, 1e-9f);
    spring.project();
    EXPECT_NEAR(spring.length(), 2.5, 1e-5);
    // Correction of 2.5 m, a quarter of it for the vertex that is three times as heavy.
    EXPECT_NEAR(spring.positions[0].x, 0.25 * 2.5 * 0.6, 1e-5);
    EXPECT_NEAR(spring.positions[1].y, 4.0 - 0.75 * 2.5 * 0.8, 1e-5);
}

TEST(Springs, OneIterationSolvesTheImplicitStepOfOneSpring) {
    // Minimum of |x - x~|^2 m / (2 h^2) + k/2 (l - rest)^2: the error shrinks by a / (w + a), where
    // a = compliance / h^2.
    const float compliance = 2e-4f;
    const double a = double{compliance} * double{kInverseH2};
    for (const int iterations : {1, 20}) {  // the later ones have nothing to add
        OneSpring spring({0, 0, 0, 1.0f}, {0, 2, 0, 2.0f}, 1.5f, compliance);
        spring.project(iterations);
        EXPECT_NEAR(spring.length(), 1.5 + 0.5 * a / (3.0 + a), 1e-6);
        EXPECT_NEAR(spring.multipliers[0], -0.5 / (3.0 + a), 1e-6);
    }
}

TEST(Springs, HeldEndsDoNotMove) {
    OneSpring one({0, 0, 0, 0.0f}, {0, 2, 0, 2.0f}, 1.0f, 1e-9f);
    one.project();
    EXPECT_EQ(one.positions[0].y, 0.0f);
    EXPECT_NEAR(one.positions[1].y, 1.0f, 1e-5);
    OneSpring both({0, 0, 0, 0.0f}, {0, 2, 0, 0.0f}, 1.0f, 1e-4f);
    both.project(3);
    EXPECT_EQ(both.positions[1].y, 2.0f);
}

TEST(Springs, OneWithoutLengthStaysAsItIs) {
    OneSpring spring({1, 2, 3, 1.0f}, {1, 2, 3, 1.0f}, 1.0f, 1e-4f);
    spring.project(3);  // no direction to push in
    EXPECT_EQ(vec(spring.positions[0]), (Vec3{1, 2, 3}));
    EXPECT_EQ(vec(spring.positions[1]), (Vec3{1, 2, 3}));
}

TEST(Springs, RestStateIsUntouchedToTheBit) {
    const float4 ends[] = {{3, 4, 0, 1}, {0, 0, -2, 5}, {2, 3, 6, 1e4f}, {1, -4, 8, 1e-3f}};
    const float lengths[] = {5, 2, 7, 9};
    for (std::size_t i = 0; i < 4; ++i) {
        OneSpring spring({0, 0, 0, 2.0f}, ends[i], lengths[i], 1e-5f);
        spring.project(5);
        EXPECT_EQ(std::memcmp(&spring.positions[1], &ends[i], sizeof(float4)), 0);
        EXPECT_EQ(vec(spring.positions[0]), Vec3{});
    }
}

TEST(Springs, ConserveLinearAndAngularMomentum) {
    // Compared with what flows from one end to the other.
    auto made = make_case("project_springs", 500, Flavour::kRandom, 3);
    auto& positions = made->buffer<float4>(0);
    auto& ends = made->buffer<int>(1);
    for (float4& x : positions.span()) x.w = made->random.real(0.1f, 10.0f);
    const std::vector<float4> before(positions.span().begin(), positions.span().end());
    run_on_host(made->launch, made->launch.kernel->form(8), 0, made->items);
    for (std::size_t s = 0; s < 500; ++s) {
        Vec3 linear, angular;
        double flow = 0.0;
        for (const std::size_t end : {s, s + 500}) {
            const auto v = static_cast<std::size_t>(ends[end]);
            const Vec3 moved = vec(positions[v]) - vec(before[v]);
            const Vec3 impulse = (1.0 / static_cast<double>(before[v].w)) * moved;
            linear = linear + impulse;
            angular = angular + cross(vec(before[v]), impulse);
            // A position is rounded to 6e-8 of its size.
            flow += (length(moved) + 0.2) / static_cast<double>(before[v].w);
        }
        EXPECT_LT(length(linear), 2e-6 * flow);
        EXPECT_LT(length(angular), 2e-6 * flow);
    }
}

TEST(Springs, PushAlongMinusTheGradientOfTheirEnergy) {
    // Where the compliance is large, a projection is a gradient step: dx = -h^2 w grad E.
    const double stiffness = 1e-3;
    OneSpring spring({0.1f, 0.2f, -0.3f, 2.0f}, {0.8f, -0.5f, 0.4f, 1.0f}, 0.7f,
                     static_cast<float>(1.0 / stiffness));
    const Vec3 x0 = vec(spring.positions[0]);
    const Vec3 x1 = vec(spring.positions[1]);
    spring.project();
    const auto energy = [&](Vec3 x) {
        const double stretch = length(x - x1) - static_cast<double>(0.7f);
        return 0.5 * stiffness * stretch * stretch;
    };
    constexpr double kStep = 1e-4;
    const double scale = 2.0 / static_cast<double>(kInverseH2);
    const Vec3 moved = vec(spring.positions[0]) - x0;
    const auto slope = [&](Vec3 along) {
        return (energy(x0 + kStep * along) - energy(x0 - kStep * along)) / (2.0 * kStep);
    };
    EXPECT_NEAR(moved.x, -scale * slope({1, 0, 0}), 1e-8);
    EXPECT_NEAR(moved.y, -scale * slope({0, 1, 0}), 2e-8);
    EXPECT_NEAR(moved.z, -scale * slope({0, 0, 1}), 3e-8);
}

}  // namespace
}  // namespace weft::test
