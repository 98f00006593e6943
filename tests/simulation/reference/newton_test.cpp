#include "simulation/reference/newton.h"
#include "simulation/families/hinges/hinges.h"
#include "simulation/families/springs/springs.h"

#include <gtest/gtest.h>

#include "simulation/families/convert.h"
#include "tests/simulation/reference/problems.h"

namespace weft::test {
namespace {

struct Problem {
    explicit Problem(const Scene& scene) : model(scene, warnings), potential(model, 0.0) {}

    Warnings warnings;
    Model model;
    IncrementalPotential potential;
};

/// x~, with the free vertices moved by up to `size`.
std::vector<Vec3> shaken_start(const IncrementalPotential& potential, double size, unsigned seed) {
    auto start = shaken(potential.predicted(), size, seed);
    for (std::size_t v = 0; v < start.size(); ++v) {
        if (!potential.is_free(static_cast<int>(v))) start[v] = potential.predicted()[v];
    }
    return start;
}

double largest_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double most = 0.0;
    for (std::size_t v = 0; v < a.size(); ++v) most = std::max(most, length(a[v] - b[v]));
    return most;
}

TEST(Newton, FindsTheSameMinimumFromEverywhere) {
    Problem problem(parse_scene(kPinnedSheet, "test.toml"));
    const Minimum minimum = minimise(problem.potential, problem.potential.predicted());
    EXPECT_LT(minimum.certificate.relative_gradient, 1e-13);
    EXPECT_LT(minimum.certificate.relative_gap, 1e-13);
    EXPECT_LT(minimum.energy, minimum.start_energy);
    for (const unsigned seed : {1U, 2U, 3U}) {
        const auto start = shaken_start(problem.potential, 0.02, seed);
        const Minimum again = minimise(problem.potential, start);
        EXPECT_LT(again.certificate.relative_gap, 1e-13);
        EXPECT_NEAR(again.energy, minimum.energy, 1e-12 * minimum.start_energy);
        EXPECT_LT(largest_distance(again.x, minimum.x), 1e-9);
    }
}

TEST(Newton, IsAMinimum) {
    Problem problem(parse_scene(kPinnedSheet, "test.toml"));
    const Minimum minimum = minimise(problem.potential, problem.potential.predicted());
    for (const double size : {1e-6, 1e-4, 1e-2}) {
        for (unsigned seed = 0; seed < 20; ++seed) {
            auto near = shaken(minimum.x, size, seed);
            for (std::size_t v = 0; v < near.size(); ++v) {
                if (!problem.potential.is_free(static_cast<int>(v))) near[v] = minimum.x[v];
            }
            EXPECT_GT(problem.potential.energy(near), minimum.energy);
        }
    }
}

/// What moves the vertices from x~ to the minimum are internal forces: together they have neither a
/// resultant nor a moment about the minimum.
TEST(Newton, MinimumConservesMomentum) {
    Scene scene = parse_scene(kPinnedSheet, "test.toml");
    scene.cloths[0].pins.clear();
    Warnings warnings;
    Model model(scene, warnings);
    for (std::size_t v = 0; v < model.positions->count(); ++v) {
        float4& x = (*model.positions)[v];
        x = {1.3f * x.x + 0.2f * x.z, 0.4f * x.x * x.x, 0.8f * x.z + 0.2f * x.x * x.z, x.w};
        (*model.velocities)[v] = to_float4({x.z, x.x * x.z, -x.y});
    }
    IncrementalPotential potential(model, 0.0);
    const Minimum minimum = minimise(potential, potential.predicted());
    Vec3 resultant, moment;
    double size = 0.0;
    for (std::size_t v = 0; v < minimum.x.size(); ++v) {
        const Vec3 force = potential.inertia()[v] * (minimum.x[v] - potential.predicted()[v]);
        resultant = resultant + force;
        moment = moment + cross(minimum.x[v], force);
        size += length(force);
    }
    EXPECT_GT(size, 1.0);
    EXPECT_LT(length(resultant), 1e-11 * size);
    EXPECT_LT(length(moment), 1e-11 * size);
}

TEST(Newton, SolvesStiffMaterialAndLongSteps) {
    for (const double stiffness : {1e-2, 1e3, 1e8}) {
        Scene scene = parse_scene(kPinnedSheet, "test.toml");
        scene.dt = 0.4;  // 0.1 s each
        scene.cloths[0].stretch.stiffness = stiffness;
        scene.cloths[0].pins[1].motion.reset();
        Problem problem(scene);
        const Minimum minimum = minimise(problem.potential, problem.potential.predicted());
        EXPECT_LT(minimum.certificate.relative_gap, 1e-12) << stiffness;
    }
}

/// Springs of no stiffness are as good as none: so a sheet becomes chains.
void cut_all_springs_but_those_along(Model& model, double Vec3::*axis) {
    Springs& springs = *model.find<Springs>();
    const int count = springs.elements().count();
    for (int s = 0; s < count; ++s) {
        const auto ends = springs.elements().vertices_of(s);
        const Vec3 along = to_vec3((*model.positions)[static_cast<std::size_t>(ends[0])]) -
                           to_vec3((*model.positions)[static_cast<std::size_t>(ends[1])]);
        if (std::abs(along.*axis) > 0.99 * length(along)) continue;
        springs.material[static_cast<std::size_t>(count + s)] = 1e30f;
    }
}

/// In a step of a thousand seconds inertia vanishes, and the minimum is a hanging chain at rest:
/// each spring is stretched by the weight below it over its stiffness.
TEST(Newton, HangingChainIsStretchedAsTheClosedFormSays) {
    constexpr int kLength = 12;
    constexpr double kStiffness = 30.0;
    Scene scene = parse_scene(kPinnedSheet, "test.toml");
    Cloth& cloth = scene.cloths[0];
    scene.dt = 4000.0;
    cloth.shape = GridShape{{0.1, 1.1}, {2, kLength}};
    cloth.transform.rotations = {{{1.0, 0.0, 0.0}, 90.0}};
    cloth.bend.reset();
    cloth.stretch.stiffness = kStiffness;
    cloth.pins.resize(1);
    cloth.pins[0].corners = {"x-z-", "x+z-"};
    Warnings warnings;
    Model model(scene, warnings);
    cut_all_springs_but_those_along(model, &Vec3::y);
    IncrementalPotential potential(model, 0.0);
    std::vector<Vec3> start;  // x~ is four thousand kilometres down
    for (const float4& x : model.positions->span()) start.push_back(to_vec3(x));
    const Minimum minimum = minimise(potential, start);

    for (int side = 0; side < 2; ++side) {
        const auto rank = [&](int row) {
            return static_cast<std::size_t>(
                model.strips.rank[static_cast<std::size_t>(2 * row + side)]);
        };
        for (int row = 1; row < kLength; ++row) {
            double weight = 0.0;
            for (int below = row; below < kLength; ++below) {
                weight += 9.81 * model.masses[rank(below)];
            }
            const Vec3 along = minimum.x[rank(row - 1)] - minimum.x[rank(row)];
            EXPECT_NEAR(along.y, 0.1 + weight / kStiffness, 1e-6);
            EXPECT_NEAR(along.x, 0.0, 1e-6);
            EXPECT_NEAR(along.z, 0.0, 1e-6);
        }
    }
}

/// An n x n sheet of side 1 bent around a cylinder of radius R without stretching, in closed form:
/// only the edges along the axis bend, (n - 1)(n - 2) of them, over an angle t = 1 / ((n - 1) R) to
/// each side. E R^2 / k = 3/2 (n - 2) / (n - 1) (sin(t/2) / (t/2))^4, which tends to 3/2.
TEST(Energies, CylinderOfASheetTendsToTheContinuum) {
    const auto cylinder = [](int n, double radius) {
        Scene scene = parse_scene(kPinnedSheet, "test.toml");
        scene.cloths[0].shape = GridShape{{1.0, 1.0}, {n, n}};
        scene.cloths[0].bend->stiffness = 1.0;
        Problem problem(scene);
        std::vector<Vec3> bent;
        for (const float4& flat : problem.model.positions->span()) {
            const Vec3 x = to_vec3(flat);
            bent.push_back({radius * std::sin(x.x / radius), radius * std::cos(x.x / radius), x.z});
        }
        const Hinges& hinges = *problem.model.find<Hinges>();
        double energy = 0.0;
        for (int h = 0; h < hinges.count(); ++h) {
            std::array<Vec3, 4> corners;
            for (std::size_t k = 0; k < 4; ++k) {
                corners[k] = bent[static_cast<std::size_t>(hinges.corners(h)[k])];
            }
            energy += hinges.energy(h, corners.data());
        }
        return energy * radius * radius;
    };
    for (const double radius : {0.5, 0.6, 10.0}) {
        for (const int n : {20, 40, 80}) {
            const double half = 0.5 / ((n - 1) * radius);
            const double expected = 1.5 * (n - 2) / (n - 1) * std::pow(std::sin(half) / half, 4.0);
            EXPECT_NEAR(cylinder(n, radius), expected, 1e-5) << n << ", " << radius;
        }
    }
    // From a separate computation.
    EXPECT_NEAR(cylinder(20, 0.6), 1.419, 5e-4);
    EXPECT_NEAR(cylinder(40, 0.6), 1.461, 5e-4);
    EXPECT_NEAR(cylinder(80, 0.6), 1.481, 5e-4);
}

}  // namespace
}  // namespace weft::test
