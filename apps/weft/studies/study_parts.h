#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "simulation/output/error_file.h"
#include "simulation/output/trajectory_file.h"

/// A study that several runs of a sweep share: each writes its curves as study.json, and whoever
/// collects them joins these to one study.
namespace weft {

/// All but the reference's positions.
nlohmann::ordered_json to_part(const ErrorStudy& study);
nlohmann::ordered_json to_part(const TrajectoryStudy& study);

/// At least one part. Where one has found a lower minimum than the others, relative errors are
/// counted from it. Throws UserError for studies of different problems, or of another kind.
ErrorStudy join_error_parts(const std::vector<nlohmann::ordered_json>& parts);
TrajectoryStudy join_trajectory_parts(const std::vector<nlohmann::ordered_json>& parts);

bool is_trajectory_part(const nlohmann::ordered_json& part);

}  // namespace weft
