#pragma once

#include <span>
#include <string>
#include <vector>

#include "simulation/model/gathered.h"

namespace weft {

/// How far the weight of what hangs together has to travel to where it is held. Local solvers carry
/// a correction a few edges per iteration and begin anew in each substep, so a long chain of short
/// edges stretches whatever its material is.
struct LoadPath {
    std::string body;     ///< the lightest one on it
    double levels = 0.0;  ///< edges from the farthest vertex to the nearest held one; of a body
                          ///< that nothing holds, half of its own, as if it hung over an obstacle
    double edge = 0.0;    ///< mean length [m]
    double burden = 1.0;  ///< the mass of all bodies that are tied together, over the lightest's
    bool is_solid = false;
    bool is_held = false;  ///< by pins
    double slender = 1.0;  ///< how many times as long as it is thick, of a solid that pins hold

    // Of what bears its weight by bending, as pins hold it, solids or cloths alone; else 0.
    /// How far a cantilever sags by 1 m/s^2 that reaches out from the pins as far: solids across
    /// gravity, cloth along its path. In parts of that length [s^2/m].
    double softness = 0.0;
    /// What holds a vertex back from moving alone along gravity, over its mass, mean [1/s^2].
    double firmness = 0.0;

    // Of cloth that bears its weight across, between pins that stay; else 0.
    double span = 0.0;    ///< from pins to pins [m]
    double slack = 0.0;   ///< how much longer than that it is at rest, in parts of it
    double pull = 0.0;    ///< what acts across it, in parts of the weight of the cloth alone
    double stride = 0.0;  ///< length of its edges along the span, mean [m]
    double wave = 0.0;    ///< how fast waves of stretch run there [m/s]
};

/// One per connected part with an edge.
/// links    pairs of vertices that elements join, besides the triangles' edges: attachments
/// gravity  [m/s^2]; 0: nothing is borne by bending
std::vector<LoadPath> load_paths(const Gathered& all, std::span<const Stencils> links,
                                 Vec3 gravity = {});

}  // namespace weft
