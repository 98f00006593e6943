#include "kernels/neighbours.h"

#include <algorithm>

#include "runtime/row_table.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

constexpr float kRadius = 0.4f;

/// Points and a table for them, made by its own rules and then handed to the case.
struct Points {
    Buffer<float4>& points;
    Buffer<int>& rows;
    Buffer<int>& counts;
    int entries = 0;

    /// room: per row; few rows have as many neighbours as the largest, so some overflow
    Points(KernelCase& c, const std::string& name, int room)
        : points(c.add<float4>(name, c.items)),
          rows(c.add<int>("rows", 2 * c.items)),
          counts(c.add<int>("counts", c.items)) {
        Buffer<int> begin("strips", 2);
        begin[1] = c.items;
        RowTable table("table", {&begin, 0, 1, 1}, room);
        std::copy_n(table.rows().data(), rows.count(), rows.data());
        entries = static_cast<int>(table.add_column<int>("others").count());
        for (float4& p : points.span()) {
            p = c.random.point(1.0f);
            p.w = c.random.integer(0, 5) == 0 ? 0.0f : 1.0f;
        }
        if (c.flavour == Flavour::kRandom) return;
        for (std::size_t i = 0; i < points.count(); ++i) {
            if (i % 3 == 0) points[i] = points[0];                        // in one place
            if (i % 7 == 1) points[i].x = points[0].x + kRadius;          // just out of reach
            if (i % 7 == 2) points[i] = {points[0].x, 9.0f, 9.0f, 1.0f};  // in the same slab only
        }
    }
};

/// Every item is among its own candidates, and those of the last pack are not a multiple of 8.
void find_case(KernelCase& c) {
    Points p(c, "points", 3);
    auto& ranges = c.add<int>("ranges", 2 * c.items);
    auto& needs = c.add<int>("needs", c.items);
    auto& others = c.add<int>("others", p.entries);
    auto& squares = c.add<float>("squares", p.entries);
    for (std::size_t i = 0; i < ranges.count(); ++i) {
        ranges[i] = i % 2 == 0 ? c.items / 10 : c.items;
    }
    for (std::size_t i = 0; i < needs.count(); ++i) {
        needs[i] = c.random.integer(0, 9);
        p.counts[i] = c.random.integer(0, 9);
    }
    for (int& other : others.span()) other = 7;
    c.launch = launch(kernels::find_neighbours, c.segments, p.points, ranges, p.rows, p.counts,
                      needs, others, squares, c.items, kRadius, kInstance);
}

/// Rows of all lengths, none included; what stands behind their ends is of no interest.
void part_case(KernelCase& c) {
    constexpr int kRoom = 12;
    Points p(c, "points", kRoom);
    auto& positions = c.add<float4>("positions", c.items);
    auto& others = c.add<int>("others", p.entries);
    auto& squares = c.add<float>("squares", p.entries);
    for (std::size_t i = 0; i < positions.count(); ++i) {
        const float4 near = c.random.point(0.5f * kRadius);
        const float4& x = p.points[i];
        positions[i] = {x.x + near.x, x.y + near.y, x.z + near.z, x.w};
        p.counts[i] = c.random.integer(0, c.random.integer(0, kRoom));
    }
    for (std::size_t e = 0; e < others.count(); ++e) {
        others[e] = c.random.integer(0, c.items - 1);
        squares[e] = c.random.real(0.0f, kRadius * kRadius);
    }
    c.launch = launch(kernels::part_neighbours, c.segments, positions, p.points, p.rows, p.counts,
                      others, squares, kRadius);
}

const bool added = add_case("find_neighbours", find_case) && add_case("part_neighbours", part_case);

}  // namespace
}  // namespace weft::test
