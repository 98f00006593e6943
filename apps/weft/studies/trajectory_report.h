#pragma once

#include <nlohmann/json.hpp>

#include "simulation/output/trajectory_file.h"

namespace weft {

/// trajectory.csv: one line per run. Runs that were not finished have no time and no distance.
std::string to_csv(const TrajectoryStudy& study);
/// The runs on the Pareto front, and how well the reference is known, for people.
std::string to_text(const TrajectoryStudy& study);
nlohmann::ordered_json to_json(const TrajectoryStudy& study);

}  // namespace weft
