#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"

namespace weft {

/// Options of `run`, most of which serve other commands too. `weft run --help` says what they mean.
struct RunOptions {
    std::string scene;
    std::string device = "hybrid";
    std::string plan = "auto";
    /// How --plan async exchanges. Given, --plan auto may choose it.
    std::optional<std::string> async;
    std::string math = "strict";
    std::string memory = "auto";
    std::string on_trouble = "stop";
    std::string on_crossing = "stop";
    std::vector<int> strips;  ///< per device; empty: planned
    // Values of the scene stay text: the scene's own check says what is wrong with them.
    std::optional<std::string> solver;
    std::optional<std::string> frames;
    std::optional<std::string> substeps;
    std::optional<std::string> iterations;
    std::vector<std::string> set;
    std::optional<std::string> out;
    bool no_geometry = false;
    bool no_trace = false;
    bool force = false;
    bool resume = false;
    double checkpoint = 10.0;  ///< [s] between two of them
    bool quiet = false;
    bool json = false;

    /// --set first, then the short forms, which win; for read_scene().
    std::vector<Override> overrides() const;
    /// Throws UserError for what this version does not have.
    SimulationOptions simulation() const;
    /// --out; left out, out/ and the scene's name.
    std::filesystem::path folder_for(const std::string& scene_name) const;
    /// Throws UserError if there is --async, and --plan is one that does nothing with it.
    void check_async() const;
};

}  // namespace weft
