#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/weft/batch/listing.h"

namespace weft::batch {

/// What --collect has found and written.
struct Collected {
    std::string name;
    Counts counts;
    std::vector<std::string> files;
    std::vector<std::string> differences;  ///< of hashes that should be equal
};

/// Writes results.csv and results.h5 into the sweep's folder; at any time, also while runs go on.
/// Throws UserError, RunError.
Collected collect(const std::filesystem::path& folder, const Manifest& manifest, bool dropped);

std::string to_text(const Collected& collected);
nlohmann::ordered_json to_json(const Collected& collected);

}  // namespace weft::batch
