#pragma once

#include <algorithm>
#include <vector>

#include "simulation/mesh/vec3.h"

namespace weft {

/// An axis-aligned box; both corners belong to it.
struct Bounds {
    Vec3 low, high;

    bool overlaps(const Bounds& other) const {
        return low.x <= other.high.x && other.low.x <= high.x && low.y <= other.high.y &&
               other.low.y <= high.y && low.z <= other.high.z && other.low.z <= high.z;
    }
    void include(const Bounds& other) {
        low = {std::min(low.x, other.low.x), std::min(low.y, other.low.y),
               std::min(low.z, other.low.z)};
        high = {std::max(high.x, other.high.x), std::max(high.y, other.high.y),
                std::max(high.z, other.high.z)};
    }
    Bounds grown(double by) const {
        const Vec3 margin{by, by, by};
        return {low - margin, high + margin};
    }
};

/// Finds the boxes that overlap a box, for checks on the host.
class BoxTree {
public:
    explicit BoxTree(std::vector<Bounds> boxes);

    int count() const { return static_cast<int>(boxes_.size()); }
    const Bounds& box(int item) const { return boxes_[static_cast<std::size_t>(item)]; }

    /// Calls visit(item) for every item whose box overlaps `box`, in an order that depends on the
    /// boxes alone.
    template <class Visit>
    void visit(const Bounds& box, Visit visit) const {
        for (std::size_t at = 0; at < nodes_.size();) {
            const Node& node = nodes_[at];
            if (!node.bounds.overlaps(box)) {
                at = static_cast<std::size_t>(node.next);
                continue;
            }
            for (int i = node.begin; i < node.end; ++i) {
                const int item = items_[static_cast<std::size_t>(i)];
                if (boxes_[static_cast<std::size_t>(item)].overlaps(box)) visit(item);
            }
            ++at;
        }
    }

private:
    /// In preorder, so that a node's first child stands right behind it.
    struct Node {
        Bounds bounds;
        int begin = 0, end = 0;  ///< of items_; none but in leaves
        int next = 0;            ///< behind all that is below this node
    };
    void build(int begin, int end);

    std::vector<Bounds> boxes_;
    std::vector<int> items_;
    std::vector<Node> nodes_;
};

}  // namespace weft
