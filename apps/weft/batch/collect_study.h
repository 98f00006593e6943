#pragma once

#include <filesystem>

#include "apps/weft/batch/collect.h"

namespace weft::batch {

/// Where the runs of a sweep are parts of a study (weft error --as-sweep): joins what they have
/// measured so far, writes the study's table and picture into the sweep's folder, and adds them to
/// the collected files. Throws UserError, RunError.
void collect_study(const std::filesystem::path& folder, const Manifest& manifest,
                   Collected& collected);

}  // namespace weft::batch
