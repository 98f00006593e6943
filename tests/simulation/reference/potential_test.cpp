#include <gtest/gtest.h>

#include <array>
#include <random>

#include "simulation/families/convert.h"
#include "simulation/reference/incremental_potential.h"
#include "tests/simulation/reference/problems.h"

namespace weft::test {
namespace {

/// A sheet with a fixed and a moving pin, or another scene, that has been torn about: some elements
/// are compressed.
struct Torn {
    explicit Torn(const std::string& scene = kPinnedSheet,
                  const std::vector<FrozenContact>& contacts = {})
        : model(parse_scene(scene, "test.toml"), warnings),
          potential(model, 0.25, contacts),
          x(shaken(potential.predicted(), 0.02, 1)) {
        potential.press_as_at(x);
    }

    Warnings warnings;
    Model model;
    IncrementalPotential potential;
    std::vector<Vec3> x;
};

/// d f / d x_i by central differences of fourth order, for one coordinate of one vertex.
template <class Function>
auto derivative(const Function& f, std::vector<Vec3> x, std::size_t vertex, double Vec3::*axis) {
    constexpr double kStep = 1e-4;
    const auto at = [&](double steps) {
        const double before = x[vertex].*axis;
        x[vertex].*axis += steps * kStep;
        const auto value = f(x);
        x[vertex].*axis = before;
        return value;
    };
    return (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * kStep);
}

class Derivatives : public testing::TestWithParam<const std::string*> {};

INSTANTIATE_TEST_SUITE_P(Scenes, Derivatives,
                         testing::Values(&kPinnedSheet, &kPinnedBlock, &kPinnedWeave));

/// Contacts of chosen vertices at x: of all stages of their energy, overlapping, and beyond range;
/// some stick and some slide.
std::vector<FrozenContact> any_contacts(const std::vector<Vec3>& x) {
    std::vector<FrozenContact> contacts;
    const auto count = static_cast<int>(x.size());
    const std::array ranges{0.9, 1.2, 3.0, 40.0, -2.0};  // by the gap
    for (int i = 0; i < 40; ++i) {
        FrozenContact c{{i % count, (i + 9) % count, (i + 20) % count, (i + 31) % count},
                        {1.0, -0.2, -0.3 - 0.01 * i, -0.5 + 0.01 * i},
                        normalized(Vec3{1.0, 0.1 * i - 2.0, 0.3}),
                        0.0,
                        0.0,
                        {},
                        {}};
        const Vec3 way = c.way(x);
        const double ratio = ranges[static_cast<std::size_t>(i) % ranges.size()];
        if (c.gap(way) * ratio < 0.0) c.normal = -c.normal;
        c.range = c.gap(way) * ratio;
        c.stiffness = 50.0 + i;
        const Vec3 along = way - c.gap(way) * c.normal;
        if (i % 3 == 0) c.earlier_slip = -0.4 * along;
        const double slip = length(along + c.earlier_slip);
        c.rubbing = {0.4, (i % 2 == 0 ? 0.4 : 1.7) * slip};
        contacts.push_back(c);
    }
    return contacts;
}

void expect_gradient(const Torn& torn) {
    const auto gradient = torn.potential.gradient(torn.x);
    const auto energy = [&](const std::vector<Vec3>& x) { return torn.potential.energy(x); };
    double size = 0.0;
    for (const Vec3& g : gradient) size = std::max(size, length(g));
    for (std::size_t v = 0; v < torn.x.size(); ++v) {
        if (!torn.potential.is_free(static_cast<int>(v))) {
            EXPECT_EQ(gradient[v], Vec3{}) << "held";
            continue;
        }
        EXPECT_NEAR(derivative(energy, torn.x, v, &Vec3::x), gradient[v].x, 1e-7 * size);
        EXPECT_NEAR(derivative(energy, torn.x, v, &Vec3::y), gradient[v].y, 1e-7 * size);
        EXPECT_NEAR(derivative(energy, torn.x, v, &Vec3::z), gradient[v].z, 1e-7 * size);
    }
}

TEST_P(Derivatives, GradientIsTheDerivativeOfTheEnergy) { expect_gradient(Torn(*GetParam())); }

void expect_hessian(Torn& torn) {
    std::mt19937 engine(3);
    const auto along = shaken(std::vector<Vec3>(torn.x.size()), 1.0, 4);
    std::vector<Vec3> direction = along;
    for (std::size_t v = 0; v < direction.size(); ++v) {
        if (!torn.potential.is_free(static_cast<int>(v))) direction[v] = {};
    }
    std::vector<Vec3> image(torn.x.size());
    torn.potential.hessian(torn.x, 0.0).multiply(direction, image);

    constexpr double kStep = 1e-5;
    const auto at = [&](double steps) {
        auto x = torn.x;
        for (std::size_t v = 0; v < x.size(); ++v) x[v] = x[v] + steps * kStep * direction[v];
        return torn.potential.gradient(x);
    };
    const auto g1 = at(1.0), g2 = at(-1.0), g3 = at(2.0), g4 = at(-2.0);
    double error = 0.0;
    double size = 0.0;
    for (std::size_t v = 0; v < image.size(); ++v) {
        const Vec3 slope = (1.0 / (12.0 * kStep)) * (8.0 * (g1[v] - g2[v]) - (g3[v] - g4[v]));
        error += dot(slope - image[v], slope - image[v]);
        size += dot(image[v], image[v]);
    }
    EXPECT_LT(std::sqrt(error / size), 1e-7);
}

TEST_P(Derivatives, HessianIsTheDerivativeOfTheGradient) {
    Torn torn(*GetParam());
    expect_hessian(torn);
}

TEST(IncrementalPotential, DerivativesOfContactsThatRub) {
    const Torn without;
    Torn torn(kPinnedSheet, any_contacts(without.x));
    const double more = torn.potential.energy(torn.x) - without.potential.energy(without.x);
    ASSERT_GT(more, 0.1 * torn.potential.energy(torn.x)) << "contacts count";
    expect_gradient(torn);
    expect_hessian(torn);
}

TEST(IncrementalPotential, OnlyTheProjectedHessianIsPositive) {
    Torn torn;
    const auto least_product = [&](double projection) {
        const BlockMatrix hessian = torn.potential.hessian(torn.x, projection);
        // The most negative curvature among directions that power iteration prefers.
        std::vector<Vec3> direction = shaken(std::vector<Vec3>(torn.x.size()), 1.0, 5);
        std::vector<Vec3> image(direction.size());
        double shift = 0.0;
        for (const Mat3& block : hessian.blocks()) {
            for (const Vec3& row : block.rows) shift = std::max(shift, length(row));
        }
        shift *= 10.0;
        double quotient = 0.0;
        for (int i = 0; i < 500; ++i) {
            hessian.multiply(direction, image);
            double square = 0.0;
            double product = 0.0;
            for (std::size_t v = 0; v < direction.size(); ++v) {
                if (!torn.potential.is_free(static_cast<int>(v))) direction[v] = {};
                square += dot(direction[v], direction[v]);
                product += dot(direction[v], image[v]);
            }
            quotient = product / square;
            for (std::size_t v = 0; v < direction.size(); ++v) {
                direction[v] = (1.0 / std::sqrt(square)) * (shift * direction[v] - image[v]);
            }
        }
        return quotient;
    };
    EXPECT_LT(least_product(0.0), 0.0) << "the state is a case";
    EXPECT_GT(least_product(1.0), 0.0);
}

TEST(IncrementalPotential, IsZeroInFreeFall) {
    Scene scene = parse_scene(kPinnedSheet, "test.toml");
    scene.cloths[0].pins.clear();
    Warnings warnings;
    Model model(scene, warnings);
    for (std::size_t v = 0; v < model.velocities->count(); ++v) {
        (*model.velocities)[v] = to_float4({1.0, 2.0, 3.0});
    }
    const IncrementalPotential potential(model, 0.0);
    EXPECT_LT(potential.energy(potential.predicted()), 1e-9);  // the positions' rounding
    const Vec3 fallen = potential.predicted()[0] - to_vec3((*model.positions)[0]);
    const double h = scene.dt / scene.substeps;
    EXPECT_LT(length(fallen - h * (Vec3{1.0, 2.0, 3.0} + h * scene.gravity)), 1e-15);
}

TEST(IncrementalPotential, HoldsPinsWhereTheyAreAtTheStepsEnd) {
    const Torn torn;
    // The second pin moves with 1 m/s along x; the step begins at 0.25 s and takes 0.01 s.
    int moving = 0;
    for (int v = 0; v < torn.model.vertex_count(); ++v) {
        if (torn.potential.is_free(v)) continue;
        const Vec3 off = torn.potential.predicted()[static_cast<std::size_t>(v)] -
                         to_vec3((*torn.model.positions)[static_cast<std::size_t>(v)]);
        if (length(off) == 0.0) continue;
        EXPECT_LT(length(off - Vec3{0.26, 0.0, 0.0}), 1e-7);
        ++moving;
    }
    EXPECT_EQ(moving, 1);
}

}  // namespace
}  // namespace weft::test
