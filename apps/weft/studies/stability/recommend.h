#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/weft/run/run_options.h"

namespace weft::stability {

/// A setting that was tried on a scene.
struct Trial {
    std::string solver;
    int substeps = 0;
    int iterations = 0;
    bool holds = false;
    double strain_rms = 0.0;  ///< of the worst frame
    double ms_per_frame = 0.0;
    std::string why;  ///< it does not hold
};

struct Advice {
    std::vector<Trial> trials;
    std::optional<Trial> cheapest;  ///< of those that hold
    int frames = 0;                 ///< that each trial had
    double strain_wanted = 0.0;
};

/// Tries solvers, iterations and ever more substeps on the scene, until each pair holds or costs
/// more than what holds already. A setting holds if the run raises no alarm and warns of nothing,
/// and strains edges by no more than half as much again as the least of all trials, or a percentage
/// point more. seconds: of trying
Advice advise(const RunOptions& options, const std::vector<std::string>& solvers, double seconds);

/// Chooses among trials; those that are strained more than others hold no longer.
/// frames: of each
Advice advice_of(std::vector<Trial> trials, int frames);

std::string to_text(const Advice& advice);
std::string to_csv(const Advice& advice);
nlohmann::ordered_json to_json(const Advice& advice);

}  // namespace weft::stability
