#pragma once

#include <vector>

#include "simulation/contact/surface.h"

namespace weft {

/// Some patches of a strip that follow each other. Where a group and what it hangs together with
/// are flat, nobody has to look at their patches (kernels/contact/near.h). That is so for groups
/// that are one piece of surface, where no border leaves room for a slit between them.
struct PatchGroups {
    std::vector<int> of_patch;  ///< [patches]
    /// Groups that a group hangs together with, itself too: with a vertex in common, or with one
    /// group between that is not at a border; and one of the two is not, either. Ascending. None of
    /// them is several pieces.
    Lists beside;
    std::vector<int> between;  ///< [entries of beside] the group between; one of the two if none is
};

/// begin: [groups + 1] the patches of each
PatchGroups find_groups(const Surface& surface, const std::vector<int>& begin);

}  // namespace weft
