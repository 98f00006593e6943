#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "simulation/output/geometry_writer.h"
#include "simulation/simulation.h"

namespace weft {

/// Of the states after 0, 1, ... `frames` frames, those that geometry has: [output] every.
std::size_t geometry_states(const Scene& scene, int frames);

/// Throws UserError where a whole run has more of them than a file may have. path: of the scene.
void check_geometry_states(const Scene& scene, const std::string& path);

/// The geometry that a run writes.
class RunGeometry {
public:
    /// Room for all states of the whole run. Throws RunError.
    RunGeometry(const std::filesystem::path& path, const Scene& scene, const Model& model);

    /// The present state, if it is one of them. Positions are found out while the next frame runs.
    void append(const Simulation& simulation);
    void finish() { writer_.finish(); }
    GeometryWriter& writer() { return writer_; }

private:
    int every_;
    GeometryWriter writer_;
};

}  // namespace weft
