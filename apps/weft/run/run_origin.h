#pragma once

#include <filesystem>
#include <optional>

#include "apps/weft/run/run_options.h"
#include "runtime/trace/records.h"

namespace weft {

/// What the results depend on, of what the user wrote, with names for messages: the scene as it was
/// read, before a solver was chosen for it. The number of frames may differ.
TextPairs request_parts(const RunOptions& options, const Scene& scene);

/// All that the results depend on: a run goes on only from a checkpoint of the same.
/// request  as above
/// meshes   their hashes, as in the run's description
TextPairs run_origin(TextPairs request, const RunOptions& options, const TextPairs& meshes,
                     const Simulation& simulation);

/// What a finished run has left in its summary, as far as it says whether it is the one asked for.
struct FinishedRun {
    TextPairs made_from;
    int frames = 0;
    std::string text;  ///< the whole summary, as JSON
};
/// None: the summary does not say it.
std::optional<FinishedRun> read_finished(const std::filesystem::path& summary);

}  // namespace weft
