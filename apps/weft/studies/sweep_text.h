#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/weft/batch/toml_values.h"
#include "apps/weft/run/run_options.h"

/// What the sweep files of studies are written with: a sweep whose runs are parts of one study.
namespace weft {

/// The table `sweep`.
struct SweepHead {
    std::string name;
    std::string command;  ///< of weft, that each run is
    std::string scene;    ///< empty: the command needs none
};

/// `sweep` and `run`.
/// run     options of the command that are the same for all
/// folder  that the file will be in
std::string sweep_head(const SweepHead& head, const batch::Value& run,
                       const std::filesystem::path& folder);

/// Options that say where and how a part is computed, where they are not what they are by
/// default.
void add_sweep_options(batch::Value& run, const RunOptions& options);

/// A run for each of the values.
std::string sweep_axis(const std::string& key, const std::vector<std::string>& values);

/// An axis of one value, as --set has it.
std::string sweep_value(const std::string& assignment);

/// Makes a sweep of the text, writes sweep.toml beside it, and says so as the options have it.
/// Throws UserError before anything is written.
void make_study_sweep(const std::string& text, const std::filesystem::path& folder,
                      const RunOptions& options);

}  // namespace weft
