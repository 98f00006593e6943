// Entries that only fill a row up are read with the rows of a pack, by any device: what they name
// has to be there.

#include "simulation/families/element_rows.h"

#include <gtest/gtest.h>

namespace weft::test {
namespace {

constexpr int kVertices = 20;

/// Springs from one vertex to all others: a long row beside short ones.
std::vector<Stencils> star() {
    Stencils springs{2, {}};
    for (int v = 1; v < kVertices; ++v) {
        springs.vertices.push_back(0);
        springs.vertices.push_back(v);
    }
    return {springs};
}

TEST(ElementRows, WhatOnlyFillsARowUpNamesTheVertexItself) {
    const auto kinds = star();
    const Strips strips = make_strips(kVertices, kinds);
    const Elements elements("springs", kinds.front(), strips);
    const VertexItems items(strips);
    ElementRows rows("rows", elements, items);
    const int hub = strips.rank[0];
    const auto slice = static_cast<std::size_t>(hub / SlicedRows::kStride);
    for (int i = 0; i < kVertices; ++i) {
        const auto item = static_cast<std::size_t>(i);
        const bool is_beside_hub = item / SlicedRows::kStride == slice;
        const int room = is_beside_hub ? kVertices - 1 : 1;
        for (int k = 0; k < room; ++k) {
            const auto entry = static_cast<std::size_t>(rows.slices()[2 * item]) +
                               SlicedRows::kStride * static_cast<std::size_t>(k);
            const int other = rows.others()[entry];
            if (i == hub)
                EXPECT_NE(other, hub) << k;
            else
                EXPECT_EQ(other, k == 0 ? hub : i) << "item " << i << ", entry " << k;
        }
    }
}

}  // namespace
}  // namespace weft::test
