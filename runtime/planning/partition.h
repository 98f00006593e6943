#pragma once

#include <span>
#include <vector>

#include "runtime/numbers.h"

namespace weft {

/// Strips [begin, end), the share of one device.
struct Part {
    int begin = 0;
    int end = 0;
    /// The copy of what the iterations work on that this part uses; 0: the maker's own buffers.
    /// Only makers that keep several copies have others.
    int iterate = 0;

    StripRange strips() const { return {begin, end}; }
    friend auto operator<=>(const Part&, const Part&) = default;
};

/// Who does what, as far as a StepMaker has to know it: a step is made for a partition. Part r is
/// the step's region r; which device it is for is the planner's business. Results do not depend on
/// it.
struct Partition {
    /// Ascending, each begins where the one before it ends, and all strips are in one of them.
    std::vector<Part> parts;

    /// All strips in one part.
    static Partition whole(int strip_count);
    /// Cut before these strips, which ascend and lie in [1, strip_count).
    static Partition at(std::span<const int> cuts, int strip_count);

    /// The same with part r on iterate r, modulo so many: what runs do that have iterates.
    Partition spread(int iterates) const;

    int strip_count() const { return parts.back().end; }

    friend auto operator<=>(const Partition&, const Partition&) = default;
};

}  // namespace weft
