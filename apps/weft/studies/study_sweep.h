#pragma once

#include <filesystem>
#include <string>

#include "apps/weft/studies/error_study.h"

namespace weft {

/// The sweep file that does a study: a run per solver, device list and plan, each with options that
/// say the same for all. `weft batch --collect` joins what they measure.
/// folder  that the file will be in; options.solvers, devices and plans are not empty
std::string study_sweep(const ErrorOptions& options, const std::string& name,
                        const std::filesystem::path& folder);

}  // namespace weft
