#pragma once

#include <string>
#include <vector>

#include "apps/weft/batch/listing.h"

namespace weft::batch {

/// What all runs have come to: a row for each, finished or not; null where nothing is known.
struct ResultsTable {
    std::vector<std::string> columns;
    std::vector<std::vector<Value>> rows;
    std::vector<bool> is_async;  ///< by row: the result depends on how the devices shared the work
};

/// index, id, the axes' keys, state, what summary.json and status.json say, and why.
ResultsTable results_table(const std::filesystem::path& folder, const std::vector<Listed>& runs);

std::string to_csv(const ResultsTable& table);

/// Results must not depend on devices, plans and repeats, but those of asynchronous plans do: says
/// which of the other runs differ only in these, and in their state hash.
std::vector<std::string> hash_differences(const ResultsTable& table,
                                          const std::vector<Listed>& runs);

}  // namespace weft::batch
