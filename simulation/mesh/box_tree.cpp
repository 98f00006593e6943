#include "simulation/mesh/box_tree.h"

#include <numeric>
#include <utility>

namespace weft {

namespace {

constexpr int kLeaf = 4;

double along(Vec3 p, int axis) { return axis == 0 ? p.x : (axis == 1 ? p.y : p.z); }

int longest_axis(const Bounds& box) {
    const Vec3 size = box.high - box.low;
    if (size.x >= size.y && size.x >= size.z) return 0;
    return size.y >= size.z ? 1 : 2;
}

}  // namespace

BoxTree::BoxTree(std::vector<Bounds> boxes) : boxes_(std::move(boxes)), items_(boxes_.size()) {
    std::iota(items_.begin(), items_.end(), 0);
    if (!items_.empty()) build(0, count());
}

void BoxTree::build(int begin, int end) {
    const auto first = items_.begin() + begin;
    const auto last = items_.begin() + end;
    Bounds bounds = box(*first);
    for (auto item = first; item != last; ++item) bounds.include(box(*item));
    const std::size_t at = nodes_.size();
    nodes_.push_back({bounds, 0, 0, 0});
    if (end - begin <= kLeaf) {
        nodes_[at].begin = begin;
        nodes_[at].end = end;
    } else {
        const int axis = longest_axis(bounds);
        const int middle = begin + (end - begin) / 2;
        const auto key = [&](int item) {
            return std::pair(along(box(item).low + box(item).high, axis), item);
        };
        std::nth_element(first, items_.begin() + middle, last,
                         [&](int a, int b) { return key(a) < key(b); });
        build(begin, middle);
        build(middle, end);
    }
    nodes_[at].next = static_cast<int>(nodes_.size());
}

}  // namespace weft
