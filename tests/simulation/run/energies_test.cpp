// The energies that a run reports, against a second implementation from the scene's triangles.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"
#include "tests/simulation/run/test_scenes.h"

namespace weft::test {
namespace {

Vec3 at(const std::vector<float>& values, int vertex) {
    const float* v = &values[3 * static_cast<std::size_t>(vertex)];
    return {v[0], v[1], v[2]};
}

/// Edges with the vertices opposite to them.
std::map<std::pair<int, int>, std::vector<int>> edges_of(const Model& model) {
    std::map<std::pair<int, int>, std::vector<int>> edges;
    for (const auto& t : model.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const int a = t[k];
            const int b = t[(k + 1) % 3];
            edges[std::minmax(a, b)].push_back(t[(k + 2) % 3]);
        }
    }
    return edges;
}

double cotangent_at(Vec3 corner, Vec3 a, Vec3 b) {
    const Vec3 u = a - corner;
    const Vec3 v = b - corner;
    return std::tan(std::numbers::pi / 2.0 - std::atan2(length(cross(u, v)), dot(u, v)));
}

/// Quadratic bending of one edge: 3 / (A0 + A1) |sum of cotangent-weighted differences|^2 / 2.
double bend_energy(const std::array<Vec3, 4>& rest, const std::array<Vec3, 4>& x) {
    const double at_0 = cotangent_at(rest[0], rest[1], rest[2]);  // of the first triangle
    const double at_1 = cotangent_at(rest[1], rest[0], rest[2]);
    const double other_0 = cotangent_at(rest[0], rest[1], rest[3]);
    const double other_1 = cotangent_at(rest[1], rest[0], rest[3]);
    const double area = 0.5 * length(cross(rest[1] - rest[0], rest[2] - rest[0])) +
                        0.5 * length(cross(rest[1] - rest[0], rest[3] - rest[0]));
    const Vec3 sum = (at_1 + other_1) * x[0] + (at_0 + other_0) * x[1] - (at_0 + at_1) * x[2] -
                     (other_0 + other_1) * x[3];
    return 0.5 * 3.0 / area * dot(sum, sum);
}

TEST(Energies, OfARunAreThoseOfItsTriangles) {
    const Scene scene = parse_scene(kEverything, "test.toml");
    Warnings warnings;
    SimulationOptions options;
    options.devices = "cpu/1";
    Simulation simulation(scene, options, warnings);
    const Model& model = simulation.model();
    const auto rest = simulation.positions();
    for (int frame = 0; frame < 4; ++frame) {
        const FrameRecord record = simulation.advance();
        const auto x = simulation.positions();
        const auto v = simulation.velocities();

        std::vector<double> masses(x.size() / 3, 0.0);
        for (std::size_t t = 0; t < model.triangles.size(); ++t) {
            const auto& c = model.triangles[t];
            const double density =
                scene.cloths[model.body_of_triangle(static_cast<int>(t))].density;
            const double area = 0.5 * length(cross(at(rest, c[1]) - at(rest, c[0]),
                                                   at(rest, c[2]) - at(rest, c[0])));
            for (const int corner : c)
                masses[static_cast<std::size_t>(corner)] += density * area / 3.0;
        }
        const auto cloth_of = [&](int vertex) -> const Cloth& {
            std::size_t body = 0;
            while (vertex >= model.bodies[body].first_vertex + model.bodies[body].vertex_count)
                ++body;
            return scene.cloths[body];
        };
        // Pins: the grids' corners (0 and 8 of the sheet), and two vertices of the band.
        const int band = model.bodies[1].first_vertex;
        double kinetic = 0.0;
        double gravity = 0.0;
        for (int i = 0; i < model.vertex_count(); ++i) {
            if (i == 0 || i == 8 || i == band || i == band + 100) continue;
            const double mass = masses[static_cast<std::size_t>(i)];
            kinetic += 0.5 * mass * dot(at(v, i), at(v, i));
            gravity += 9.81 * mass * at(x, i).y;
        }
        double stretch = 0.0;
        double bend = 0.0;
        for (const auto& [edge, opposite] : edges_of(model)) {
            const auto [a, b] = edge;
            const double longer = length(at(x, a) - at(x, b)) - length(at(rest, a) - at(rest, b));
            stretch += 0.5 * cloth_of(a).stretch.stiffness * longer * longer;
            if (opposite.size() != 2 || !cloth_of(a).bend) continue;
            const auto corners = [&](const std::vector<float>& p) {
                return std::array<Vec3, 4>{at(p, a), at(p, b), at(p, opposite[0]),
                                           at(p, opposite[1])};
            };
            bend += cloth_of(a).bend->stiffness * bend_energy(corners(rest), corners(x));
        }
        EXPECT_NEAR(record.kinetic_energy, kinetic, 1e-6 * kinetic);
        EXPECT_NEAR(record.gravity_energy, gravity, 1e-6 * gravity);
        ASSERT_EQ(record.energies.size(), 2U);
        EXPECT_NEAR(record.energies[0], stretch, 1e-4 * stretch);
        EXPECT_NEAR(record.energies[1], bend, 1e-4 * bend);
        EXPECT_GT(bend, 0.0);
    }
}

}  // namespace
}  // namespace weft::test
