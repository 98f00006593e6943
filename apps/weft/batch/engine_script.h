#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/weft/batch/manifest.h"

namespace weft::batch {

/// Engines that a script can be had for.
const std::vector<std::string>& engines();

/// A script that has an engine do all runs of a sweep; it is printed, never submitted.
/// docs/batch.md says more about each.
std::string script_for(const std::string& engine, const Manifest& manifest,
                       const std::filesystem::path& folder);

}  // namespace weft::batch
