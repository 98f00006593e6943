#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "simulation/mesh/vec3.h"
#include "tests/simulation/run/manual_run.h"

/// Scenes of blocks of 10 cm in contact.
namespace weft::test {

inline std::string head(int iterations, const std::string& contact, const std::string& gravity = "",
                        int substeps = 10) {
    return fmt::format(R"(
[scene]
frames = 1
dt = 0.016666667
substeps = {}
{}
[solver]
iterations = {}
[contact]
thickness = 0.004
{}
)",
                       substeps, gravity, iterations, contact);
}

inline std::string block(const std::string& name, Vec3 place, double density, double young,
                         int turn) {
    return fmt::format(R"(
[[solid]]
name = "{}"
grid = {{ size = [0.1, 0.1, 0.1], resolution = [4, 4, 4] }}
rotate = [0, 1, 0, {}]
translate = [{}, {}, {}]
density = {}
young = {}
poisson = 0.3
)",
                       name, turn, place.x, place.y, place.z, density, young);
}

/// Its number among the model's bodies.
inline int body_of(const ManualRun& run, int vertex) {
    const auto has = [&](const BodyRange& body) {
        return body.has(run.model->scene_vertex(vertex));
    };
    const auto body = std::ranges::find_if(run.model->bodies, has);
    return static_cast<int>(body - run.model->bodies.begin());
}

}  // namespace weft::test
