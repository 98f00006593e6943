#pragma once

#include <string>
#include <vector>

#include "simulation/scene/scene.h"

namespace weft {

/// One value of a scene given from outside, as in `--set scene.frames=20`.
struct Override {
    std::string assignment;  ///< "table.key=value"; the value in TOML, bare words count as strings
    std::string origin;      ///< how the user gave it, for messages: "--frames 20"
};

/// Reads and checks a scene file. Throws UserError with file, line, column and key.
Scene read_scene(const std::string& path, const std::vector<Override>& overrides = {});

/// The same for a text; `path` stands in messages, and its folder is where meshes are looked for.
Scene parse_scene(const std::string& text, const std::string& path,
                  const std::vector<Override>& overrides = {});

/// The JSON Schema (draft 2020-12) of scene files, indented, from the same table that checks them.
std::string scene_json_schema();

}  // namespace weft
