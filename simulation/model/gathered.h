#pragma once

#include <array>
#include <string>
#include <vector>

#include "simulation/families/builder.h"
#include "simulation/model/moving_pins.h"

namespace weft {

/// What bears a body's weight by bending: of cloth [kg/m^2, J], of a solid [kg/m^3, Pa].
struct Bearing {
    double density = 0.0;
    double stiffness = 0.0;  ///< 0: nothing does
};

/// Everything about a scene's bodies before strips are known, in scene order: the vertices of the
/// cloths, those of the solids, those of the obstacles' meshes.
struct Gathered {
    std::vector<BodyRange> bodies;
    std::vector<Bearing> bearings;  ///< [bodies]
    /// Of cloths all, of solids their surface; what geometry files show.
    std::vector<std::array<int, 3>> triangles;
    /// No elements, but what lies together in an obstacle's surface lies together in the order.
    Stencils obstacle_triangles{3, {}};

    Vec3 origin;                  ///< that all positions here count from; see origin.h
    std::vector<Vec3> rest;       ///< [vertices] [m]
    std::vector<double> masses;   ///< [vertices] [kg]
    std::vector<char> held;       ///< [vertices]
    std::vector<double> damping;  ///< [vertices] [1/s]
    bool is_damped = false;
    std::vector<MovingPins::Group> moving;

    /// Of elements that there are, in the order of element_families.h.
    std::vector<std::unique_ptr<FamilyBuilder>> families;
};

/// Throws UserError for what is wrong with the scene's meshes, pins and attachments.
Gathered gather(const Scene& scene, Warnings& warnings);

}  // namespace weft
