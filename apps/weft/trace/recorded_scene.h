#pragma once

#include <optional>
#include <string>

#include "runtime/trace/records.h"
#include "simulation/scene/scene.h"

namespace weft {

/// A setting of a run, empty if the trace has none of that name.
std::string recorded_setting(const RunDescription& run, const std::string& name);

/// The scene of a trace with everything that the command line changed. Mesh files are looked for
/// beside the scene file, where it was or where it is now (`scene_path`). Throws UserError if one
/// has gone or changed since.
Scene recorded_scene(const RunDescription& run, const std::optional<std::string>& scene_path);

}  // namespace weft
