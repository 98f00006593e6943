#pragma once

#include <array>
#include <vector>

#include "simulation/topology/stencils.h"
#include "simulation/topology/strips.h"

namespace weft {

/// The two halves of an iteration: elements between two strips, and elements inside one.
enum Phase { kSeamPhase = 0, kInnerPhase = 1 };
inline constexpr int kPhaseCount = 2;

struct ElementRange {
    int begin = 0;
    int end = 0;

    int count() const { return end - begin; }
    bool empty() const { return begin == end; }
};

/// The elements of one kind, stored by (phase, strip, colour), and by lowest vertex within. So what
/// a strip needs, and what a range of strips needs, is one stretch of memory.
///
/// Elements of one phase and colour share no vertex, in all strips together. Seam s counts as strip
/// s, so the last strip's seam segments are empty. This order defines the result of a Gauss-Seidel
/// sweep; it depends on the mesh only, never on devices.
struct ElementLayout {
    int strip_count = 0;
    std::array<int, kPhaseCount> colour_count{};  ///< of the phase, the most that any strip needs
    std::vector<int> order;                       ///< [stencils.count()] new element -> old element
    /// [segment_count() + 1] segment i = new elements [segment_begin[i], segment_begin[i + 1])
    std::vector<int> segment_begin;
    Stencils stencils;  ///< new elements in new vertices

    int segment_count() const { return (colour_count[0] + colour_count[1]) * strip_count; }

    int segment(int phase, int colour, int strip) const {
        const int before = phase == kSeamPhase ? 0 : colour_count[kSeamPhase] * strip_count;
        return before + strip * colour_count[phase] + colour;
    }

    /// The elements of one segment.
    ElementRange elements(int phase, int colour, int strip) const {
        const int at = segment(phase, colour, strip);
        return {segment_begin[at], segment_begin[at + 1]};
    }

    /// Number of elements of one phase, all colours, in strips [first_strip, last_strip).
    int item_count(int phase, int first_strip, int last_strip) const {
        return segment_begin[segment(phase, 0, last_strip)] -
               segment_begin[segment(phase, 0, first_strip)];
    }
};

/// Colours and sorts one kind of element. The kind must have been among those that made the strips.
ElementLayout make_layout(const Stencils& kind, const Strips& strips);

}  // namespace weft
