#pragma once

#include <vector>

#include "simulation/contact/surface.h"

namespace weft {

/// Some patches of a strip that follow each other. Where a group and what it hangs together with
/// are flat, nobody has to look at their patches (kernels/contact/near.h).
struct PatchGroups {
    std::vector<int> of_patch;  ///< [patches]
    /// Groups that a group hangs together with, itself too: with a vertex in common, or with one
    /// group between. All of these are one piece of surface each, and there is no slit between
    /// them: of the two one is not at a border, and what is between is not, either; or the border
    /// of all of them is about straight, or turns outward (leave_no_slit). Ascending.
    Lists beside;
    std::vector<int> between;  ///< [entries of beside] the group between; one of the two if none is
};

/// surface  up to its turns
/// begin    [groups + 1] the patches of each
PatchGroups find_groups(const Surface& surface, const std::vector<int>& begin);

}  // namespace weft
