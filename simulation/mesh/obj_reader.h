#pragma once

#include <string>
#include <string_view>

#include "simulation/mesh/triangle_mesh.h"

namespace weft {

/// Reads the vertices and triangles of a Wavefront OBJ file. Objects and groups become parts;
/// texture coordinates, normals, materials, lines and points are passed over. Throws UserError,
/// with the line, where the file is missing, unreadable or empty, and for a coordinate that is not
/// a finite number, a face that is not a triangle, an index that is not a vertex, and a triangle
/// that names a vertex twice. What else can be wrong is for check_mesh() to see.
TriangleMesh read_obj(const std::string& path, Warnings& warnings);

/// The same for a text; `path` stands in messages.
TriangleMesh parse_obj(std::string_view text, const std::string& path, Warnings& warnings);

}  // namespace weft
