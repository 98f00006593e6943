#pragma once

#include <vector>

#include "simulation/model/model.h"

namespace weft {

/// An end of a tie, seen from the part that it belongs to.
struct PartTie {
    static constexpr int kNone = -1;

    int part;        ///< number of `vertices`
    int vertex;      ///< of the part, new order
    int other;       ///< the other end,
    int other_part;  ///< and whose it is; kNone: of a part that is held
    Tie tie;
};

/// Parts are what hangs together without ties. Those count of which no vertex is held, but of what
/// ties bind them to, directly or by others. (What ties bind together that hangs free lies on
/// something, which is not known before the iterations.)
struct TieTable {
    std::vector<std::vector<int>> vertices;  ///< [parts] new order, ascending
    std::vector<PartTie> ties;               ///< part by part; those of two parts are there twice
};

TieTable find_part_ties(const Model& model);

}  // namespace weft
