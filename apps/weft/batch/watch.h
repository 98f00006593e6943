#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/weft/batch/listing.h"

namespace weft::batch {

/// Tells on stderr how far a sweep is, again and again, until all of its runs are finished or
/// failed: counts, the time left, and each failure once. A line that stays in its place on a
/// terminal, a new one whenever something has changed otherwise.
void watch(const std::filesystem::path& folder, const Manifest& manifest);

/// [s] that the rest takes if as many runs as now go on side by side, each as long as the finished
/// ones took on average. None while nothing is finished, or nothing runs.
std::optional<double> time_left(const std::vector<Listed>& runs);

}  // namespace weft::batch
