#pragma once

#include <string>

namespace weft {

/// What a mesh file is by its ending: "OBJ", "PLY", "glTF" ...; "" where nobody knows it.
std::string mesh_format(const std::string& path);

/// Throws UserError for a cloth's mesh file of another format than OBJ, by its name.
void require_obj(const std::string& path);

/// "PLY is not read here: ", for messages about a wrong format; "" for an unknown one.
std::string other_format(const std::string& path);

}  // namespace weft
