#include "tests/simulation/run/physics.h"

#include <algorithm>

#include "simulation/families/convert.h"
#include "simulation/scene/read_scene.h"

namespace weft::test {

Scene EverySolver::scene_of(const std::string& text) {
    Scene scene = parse_scene(text, "test.toml");
    scene.solver.method = GetParam();
    return scene;
}

std::string name_of_method(const testing::TestParamInfo<Method>& info) {
    return std::string(name_of(info.param));
}

std::vector<float> positions(const ManualRun& run) {
    return run.in_scene_order(*run.model->positions);
}

std::vector<float> velocities(const ManualRun& run) {
    return run.in_scene_order(*run.model->velocities);
}

Vec3 at(const std::vector<float>& values, int vertex) {
    const float* v = &values[3 * static_cast<std::size_t>(vertex)];
    return {v[0], v[1], v[2]};
}

double difference(const std::vector<float>& a, const std::vector<float>& b) {
    double most = 0.0;
    for (int v = 0; v < static_cast<int>(a.size() / 3); ++v) {
        most = std::max(most, length(at(a, v) - at(b, v)));
    }
    return most;
}

std::vector<float> turned_back(std::vector<float> values, Vec3 axis, double degrees) {
    const Mat3 back = transposed(rotation_matrix(axis, degrees));
    for (std::size_t first = 0; first < values.size(); first += 3) {
        const Vec3 p = back * at(values, static_cast<int>(first / 3));
        values[first] = static_cast<float>(p.x);
        values[first + 1] = static_cast<float>(p.y);
        values[first + 2] = static_cast<float>(p.z);
    }
    return values;
}

Fall free_fall(const Scene& scene, double damping, int frames) {
    Fall fall;
    const double h = scene.dt / scene.substeps;
    for (int substep = 0; substep < frames * scene.substeps; ++substep) {
        fall.v = fall.v + h * scene.gravity;
        fall.x = fall.x + h * fall.v;
        fall.v = (1.0 / (1.0 + h * damping)) * fall.v;
    }
    return fall;
}

Momentum momentum_of(const ManualRun& run, int first, int count) {
    Momentum sum;
    const auto x = positions(run);
    const auto u = velocities(run);
    for (int v = first; v < first + count; ++v) {
        const auto rank =
            static_cast<std::size_t>(run.model->strips.rank[static_cast<std::size_t>(v)]);
        const double m = run.model->masses[rank];
        sum.place = sum.place + m * at(x, v);
        sum.velocity = sum.velocity + m * at(u, v);
        sum.mass += m;
    }
    return {sum.mass, (1.0 / sum.mass) * sum.place, (1.0 / sum.mass) * sum.velocity};
}

Momentum momentum_of(const ManualRun& run, int body) {
    const BodyRange& range = run.model->bodies[static_cast<std::size_t>(body)];
    return momentum_of(run, range.first_vertex, range.vertex_count);
}

double run_without_momentum(ManualRun& run, int frames, double tolerance) {
    double largest = 0.0;
    for (int frame = 0; frame < frames; ++frame) {
        run.run(1);
        Vec3 linear, angular;
        double size = 0.0;
        for (std::size_t v = 0; v < run.model->masses.size(); ++v) {
            const Vec3 p = run.model->masses[v] * to_vec3((*run.model->velocities)[v]);
            linear = linear + p;
            angular = angular + cross(to_vec3((*run.model->positions)[v]), p);
            size += length(p);
        }
        // What one constraint moves while another is projected is of second order for the angular
        // momentum; all else is rounding.
        largest = std::max(largest, size);
        EXPECT_LT(length(linear), tolerance * largest);
        EXPECT_LT(length(angular), 2.5 * tolerance * largest);
    }
    return largest;
}

double kinetic_energy(const ManualRun& run) {
    double sum = 0.0;
    for (std::size_t v = 0; v < run.model->masses.size(); ++v) {
        const Vec3 u = to_vec3((*run.model->velocities)[v]);
        sum += 0.5 * run.model->masses[v] * dot(u, u);
    }
    return sum;
}

}  // namespace weft::test
