#pragma once

#include <filesystem>
#include <vector>

#include "apps/weft/batch/results_table.h"

namespace weft::batch {

/// results.h5: group `runs` with a dataset per column of the table, and group `traces` with an
/// external link <index> to each run's trace.h5, relative to the file. Nothing is copied. Throws
/// RunError.
void write_results_file(const std::filesystem::path& path, const ResultsTable& table,
                        const std::filesystem::path& folder, const std::vector<Listed>& runs);

}  // namespace weft::batch
