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
};

/// One per connected part with an edge.
/// links  pairs of vertices that elements join, besides the triangles' edges: attachments
std::vector<LoadPath> load_paths(const Gathered& all, std::span<const Stencils> links);

/// The strain (RMS) that unfinished sweeps leave, at least about: n sweeps are no stiffer than m n
/// / (2 h^2) per edge, and the weight of all levels hangs on the last one: 2 g h^2 levels burden /
/// (n edge). Measured: 1 to 2.5 times this (docs/scenes.md).
/// h  the substep [s]; gravity  [m/s^2]
double unfinished_strain(const LoadPath& path, double h, int iterations, double gravity);

/// The number of substeps that keeps it at half a per cent (of solids, whose bending adds to it, at
/// a fifth of that, and less the more slender they are), and a substep at 1/240 s or less.
/// dt  the frame [s]
int believable_substeps(std::span<const LoadPath> paths, double dt, int iterations, double gravity);

}  // namespace weft
