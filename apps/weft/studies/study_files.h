#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/weft/studies/stability/outcome.h"
#include "apps/weft/studies/stability/recommend.h"
#include "simulation/output/error_file.h"
#include "simulation/output/trajectory_file.h"

namespace weft {

/// Writes error.csv, the picture (error.svg, and error.png where there is cairo), and, where the
/// reference's positions are known, error.h5. What was written, for people. Throws UserError,
/// RunError.
std::string write_study(const std::filesystem::path& folder, const ErrorStudy& study);
/// The same for trajectory.csv and so on.
std::string write_study(const std::filesystem::path& folder, const TrajectoryStudy& study);
/// stability.csv and the picture.
std::string write_study(const std::filesystem::path& folder,
                        const std::vector<stability::Row>& rows);
/// settings.csv.
std::string write_study(const std::filesystem::path& folder, const stability::Advice& advice);

}  // namespace weft
