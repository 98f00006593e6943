#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "apps/weft/batch/manifest.h"
#include "apps/weft/batch/run_folder.h"

namespace weft::batch {

// Exit codes of a run. The last one: stopped in good order, the same command goes on (EX_TEMPFAIL
// of sysexits.h).
constexpr int kFailed = 1;
constexpr int kWrongRequest = 2;
constexpr int kGoesOn = 75;

/// Where the files of a sweep are.
std::filesystem::path run_path(const std::filesystem::path& folder, const Run& run);
std::filesystem::path scene_path(const std::filesystem::path& folder, const Run& run);

struct DriveOptions {
    bool again = false;  ///< failed runs are done again: killed ones go on, others start anew
    bool quiet = false;
    std::string weft;  ///< version
};

/// What one run has come to.
struct Outcome {
    std::size_t index = 0;
    int exit_code = 0;  ///< 0 finished, 1 failed, 2 wrong request, kGoesOn
    std::string why;    ///< it is not 0
    std::size_t warnings = 0;
};

/// The program itself, given its arguments, in this process.
using Program = std::function<int(const std::vector<std::string>& arguments)>;

/// Does these runs one after the other, each in a process of its own, going on where one had
/// stopped; finished ones are done. Stops in good order when asked to, or before the time limit:
/// the rest is then left for the next call. Throws RunError.
std::vector<Outcome> drive(const std::filesystem::path& folder, const Manifest& manifest,
                           const std::vector<std::size_t>& indices, const DriveOptions& options,
                           const Program& program);

}  // namespace weft::batch
