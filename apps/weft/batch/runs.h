#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "apps/weft/batch/sweep.h"
#include "simulation/scene/scene.h"

namespace weft::batch {

/// One run of a sweep, as the manifest holds it.
struct Run {
    std::size_t index = 0;
    std::string id;     ///< 12 hex digits over all that the result depends on; its folder's name
    std::string scene;  ///< relative to the sweep's folder; empty: the command has its own
    std::string scene_hash;                             ///< of its text and its meshes
    std::vector<std::pair<std::string, Value>> values;  ///< of the axes
    std::vector<std::string> arguments;  ///< of the equivalent `weft run`, but for scene and --out
    bool dropped = false;                ///< the sweep has it no more
};

/// What the command line of a subcommand takes.
struct CommandLine {
    /// Its options by their keys of the table `run` (max_work, geometry), and whether each is a
    /// flag.
    std::map<std::string, bool> flags;
    /// Throws UserError for arguments that it would refuse.
    std::function<void(const std::vector<std::string>& arguments)> check;
};

/// All runs of a sweep, every one of them read as a scene. Throws UserError with the place of the
/// value that is wrong, and for two runs that are the same.
/// folder  of the sweep, which the scenes' paths become relative to
std::vector<Run> runs_of(const Sweep& sweep, const std::filesystem::path& folder,
                         const CommandLine& command_line);

/// What a scene's file and its meshes hold, as a hash. Files are read once.
class SceneHashes {
public:
    std::string of(const Scene& scene);

private:
    std::vector<std::pair<std::string, std::string>> meshes_;
};

}  // namespace weft::batch
