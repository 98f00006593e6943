#pragma once

#include <array>
#include <string>
#include <vector>

#include "simulation/mesh/triangle_mesh.h"
#include "simulation/model/moving_pins.h"
#include "simulation/model/stiffness.h"
#include "simulation/scene/scene.h"
#include "simulation/topology/stencils.h"

namespace weft {

/// A range of the scene's vertices that belongs to one cloth or solid.
struct BodyRange {
    std::string name;
    std::string kind;  ///< "cloth" or "solid"
    int first_vertex = 0;
    int vertex_count = 0;
};

/// Everything about a scene's bodies before strips are known, in scene order: the vertices of the
/// cloths, then those of the solids.
struct Gathered {
    std::vector<BodyRange> bodies;
    /// Of cloths all, of solids their surface; what geometry files show.
    std::vector<std::array<int, 3>> triangles;
    std::vector<int> triangle_body;  ///< [triangles]

    std::vector<Vec3> rest;       ///< [vertices] [m]
    std::vector<double> masses;   ///< [vertices] [kg]
    std::vector<char> held;       ///< [vertices]
    std::vector<double> damping;  ///< [vertices] [1/s]
    bool is_damped = false;
    std::vector<MovingPins::Group> moving;

    /// Edges of cloths, then attachments.
    Stencils springs{2, {}};
    std::vector<double> spring_stiffness;  ///< [N/m]
    int edge_count = 0;                    ///< how many of the springs are edges
    Stencils membranes{3, {}};
    std::vector<Stiffness> membrane_stiffness;  ///< [N/m]
    Stencils hinges{4, {}};
    std::vector<double> hinge_stiffness;  ///< [J]
    Stencils tetrahedra{4, {}};
    std::vector<Stiffness> tetrahedron_stiffness;  ///< [Pa]
};

/// Throws UserError for what is wrong with the scene's meshes, pins and attachments.
Gathered gather(const Scene& scene, Warnings& warnings);

}  // namespace weft
