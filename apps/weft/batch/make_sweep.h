#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "apps/weft/batch/manifest.h"

namespace weft::batch {

/// out/<name>, or what was asked for.
std::filesystem::path sweep_folder(const std::string& name, const std::optional<std::string>& out);

/// What the making of a sweep has found and written.
struct Made {
    std::string name;
    std::filesystem::path folder;
    std::size_t current = 0;  ///< runs that the sweep has
    std::size_t added = 0;    ///< of these, new ones
    std::size_t dropped = 0;  ///< that the sweep has no more, all in all
};

/// Checks every run of a sweep, and writes its manifest. Throws UserError before anything is
/// written.
Made make_sweep(const Sweep& sweep, const std::filesystem::path& folder);

std::string to_text(const Made& made);
/// What a user may do with it.
std::string next_steps(const std::string& sweep_file);
nlohmann::ordered_json to_json(const Made& made);

}  // namespace weft::batch
