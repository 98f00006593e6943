#pragma once

#include <vector>

#include "simulation/solver/body_hinge.h"
#include "simulation/solver/free_bodies.h"

namespace weft {

/// A body of which some vertices are held, and where.
struct HeldBody {
    FreeBodies::Whole whole;
    std::vector<int> vertices;  ///< none: it is free, and its hinge a vertex of it
    BodyHinge hinge;
    /// Whether a motion of all that is free says how it moves: of solids, of cloth that hangs to
    /// one side of what holds it, and of what is free.
    bool goes_as_a_whole;
};

bool is_held(const Model& model, int vertex);

/// Those that can be moved as wholes: solids, and cloth that hangs to one side of what holds it.
std::vector<HeldBody> held_bodies(const Model& model);
/// All with elements that may move, held or free.
std::vector<HeldBody> movable_bodies(const Model& model);

std::vector<FreeBodies::Whole> wholes_of(const std::vector<HeldBody>& bodies);

}  // namespace weft
