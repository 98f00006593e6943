#pragma once

#include <string>
#include <string_view>

#include "simulation/mesh/polygon_mesh.h"
#include "simulation/mesh/triangle_mesh.h"

namespace weft {

/// Reads the vertices and faces of a Wavefront OBJ file; faces with more than three corners are
/// split into triangles (polygon.h). Objects and groups become parts; texture coordinates, normals,
/// materials, lines and points are passed over. Throws UserError, with the line, where the file is
/// missing, unreadable, empty or of another format, and for a coordinate that is not a finite
/// number, a face of less than three corners, that names a vertex twice or crosses itself, and an
/// index that is not a vertex. What else can be wrong is for mesh_checks.h to see.
TriangleMesh read_obj(const std::string& path, Warnings& warnings);

/// The same for a text; `path` stands in messages.
TriangleMesh parse_obj(std::string_view text, const std::string& path, Warnings& warnings);

/// The same as read_obj(), with the rest shape of another file, whose faces are split alike. Throws
/// UserError, too, where that does not have as many corners in as many faces.
TriangleMesh read_obj_with_rest(const std::string& path, const std::string& rest_path,
                                Warnings& warnings);

/// Faces as they stand in a file, and at which line.
struct ObjFaces {
    PolygonMesh mesh;
    std::vector<std::size_t> lines;  ///< [faces]
};

/// parse_obj() without the splitting.
ObjFaces parse_obj_faces(std::string_view text, const std::string& path, Warnings& warnings);

}  // namespace weft
