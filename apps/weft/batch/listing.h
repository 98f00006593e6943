#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "apps/weft/batch/manifest.h"
#include "apps/weft/batch/run_folder.h"

namespace weft::batch {

/// A run and what has become of it.
struct Listed {
    const Run* run = nullptr;
    Status status;
};

/// All runs that the sweep still has, or all, now. `manifest` must outlive the list.
std::vector<Listed> list_runs(const std::filesystem::path& folder, const Manifest& manifest,
                              bool dropped);
std::vector<Listed> with_states(std::vector<Listed> runs, const std::vector<State>& states);

std::vector<std::size_t> indices_of(const std::vector<Listed>& runs);

/// How many runs have come how far.
struct Counts {
    std::map<State, std::size_t> states;
    std::size_t warned = 0;  ///< of the finished ones, those with warnings
};
Counts count_states(const std::vector<Listed>& runs);
/// "3 finished (1 warned), 1 failed", without those that there are none of.
std::string counts_text(const Counts& counts);

std::string to_table(const std::vector<Listed>& runs);
nlohmann::ordered_json to_json(const std::vector<Listed>& runs);
/// One per line, for engines without numbers: each may be repeated, and goes on.
std::string to_commands(const std::vector<Listed>& runs, const std::filesystem::path& folder);

/// A word of a shell, quoted where it has to be.
std::string shell_word(const std::string& text);

/// "solver.method = xpbd, run.device = cpu/1"
std::string values_text(const Run& run);

}  // namespace weft::batch
