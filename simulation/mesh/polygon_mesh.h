#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "simulation/mesh/triangle_mesh.h"

namespace weft {

/// Faces with any number of corners over shared vertices, as a file has them.
struct PolygonMesh {
    /// A run of faces under the same names.
    struct Part {
        std::string object;
        std::string group;
        std::size_t first_face = 0;
        std::size_t face_count = 0;
    };

    std::vector<Vec3> positions;                 ///< [m]
    std::vector<int> corners;                    ///< [all corners] the vertex of each
    std::vector<std::size_t> face_begin{0};      ///< [faces + 1] in `corners`
    std::vector<Part> parts;                     ///< cover all faces, in order
    std::string source;                          ///< file name
    std::vector<std::array<double, 2>> texture;  ///< [texture points] u, v
    /// [all corners] the texture point of each; empty: some corner has none
    std::vector<int> texture_corners;

    std::size_t face_count() const { return face_begin.size() - 1; }
    std::span<const int> face(std::size_t f) const {
        return std::span(corners).subspan(face_begin[f], face_begin[f + 1] - face_begin[f]);
    }
};

/// Triangles as places in `corners`, face by face.
struct FaceSplit {
    std::vector<std::array<std::size_t, 3>> triangles;
    std::vector<std::size_t> triangle_begin{0};  ///< [faces + 1]
};

/// Splits every face (polygon.h). Throws UserError for one that crosses itself or has no area;
/// triangles are taken as they are. line_of: of a face in its file, for the message
FaceSplit split_faces(const PolygonMesh& mesh, std::span<const std::size_t> line_of);

/// The mesh of the triangles, with its parts.
TriangleMesh triangles_of(const PolygonMesh& mesh, const FaceSplit& split);

}  // namespace weft
