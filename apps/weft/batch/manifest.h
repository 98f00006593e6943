#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/weft/batch/runs.h"

namespace weft::batch {

/// What a sweep was when it was made (manifest.jsonl): jobs that wait in a queue run what was
/// submitted, whatever has become of the sweep file.
struct Manifest {
    std::string name;
    std::string command;               ///< the subcommand that each run is
    std::string weft;                  ///< the version that wrote it
    std::string file;                  ///< the sweep file, relative to the folder; empty: not known
    std::string sweep;                 ///< its text
    std::optional<double> time_limit;  ///< [s] per process of --index
    std::vector<Run> runs;             ///< runs[i].index == i

    /// Those that the sweep still has.
    std::vector<std::size_t> current() const;
};

/// A line of JSON for the head, then one per run.
std::string to_jsonl(const Manifest& manifest);

std::filesystem::path manifest_path(const std::filesystem::path& folder);

/// Throws UserError if it is missing, or is none.
Manifest read_manifest(const std::filesystem::path& folder);
/// Two sweep files of one name have one folder: throws UserError where another one than this, which
/// is still there, has made the manifest.
void check_made_by(const Manifest& manifest, const std::filesystem::path& folder,
                   const std::string& sweep_file);
/// As a whole or not at all. Throws RunError.
void write_manifest(const std::filesystem::path& folder, const Manifest& manifest);

/// The runs of a sweep as it is now, with the numbers that they have had: known ones keep theirs,
/// new ones come behind, and those that the sweep has no more stay, dropped.
std::vector<Run> merged(const std::vector<Run>& before, std::vector<Run> now);

}  // namespace weft::batch
