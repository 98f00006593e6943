#pragma once

// What cases of contact kernels are made of.

#include <algorithm>

#include "runtime/row_table.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {

inline constexpr float kHalo = 0.2f;
inline constexpr float kLeast = 0.02f;

inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Points with a reach; in degenerate cases many in one place, or in one plane.
inline Buffer<float4>& add_points(KernelCase& c, const std::string& name, int count) {
    auto& points = c.add<float4>(name, count);
    for (int p = 0; p < count; ++p) {
        points[at(p)] = c.random.point(0.6f);
        points[at(p)].w = c.random.real(0.0f, 0.1f);
        if (c.flavour == Flavour::kRandom) continue;
        if (p % 3 == 1) points[at(p)] = points[at(p / 4)];
        if (p % 5 == 0) points[at(p)].y = 0.0f;
    }
    return points;
}

/// Any of so many, column by column.
inline Buffer<int>& add_numbers(KernelCase& c, const std::string& name, int count, int of) {
    auto& numbers = c.add<int>(name, count);
    for (int& number : numbers.span()) number = c.random.integer(0, of - 1);
    return numbers;
}

/// Where lists begin; `least` to `most` long.
inline Buffer<int>& add_begins(KernelCase& c, const std::string& name, int count, int least,
                               int most) {
    auto& begin = c.add<int>(name, count + 1);
    for (int n = 0; n < count; ++n) begin[at(n + 1)] = begin[at(n)] + c.random.integer(least, most);
    return begin;
}

/// Boxes with a reach, small enough to be apart now and then.
struct Boxes {
    Buffer<float4>& low;
    Buffer<float4>& high;

    Boxes(KernelCase& c, const std::string& name, int count, float size)
        : low(c.add<float4>(name + ".low", count)), high(c.add<float4>(name + ".high", count)) {
        for (int b = 0; b < count; ++b) {
            const float4 x = c.random.point(0.6f);
            const float q = c.random.real(0.0f, size);
            low[at(b)] = {x.x - q, x.y - q, x.z - q, 0.0f};
            high[at(b)] = {x.x + q, x.y + q, x.z + q, c.random.real(0.0f, 0.1f)};
        }
    }
};

inline void make_empty(float4& low, float4& high) {
    low = {1e30f, 1e30f, 1e30f, 0.0f};
    high = {-1e30f, -1e30f, -1e30f, 0.0f};
}

inline void include(float4& low, float4& high, const float4& other_low, const float4& other_high) {
    low = {std::min(low.x, other_low.x), std::min(low.y, other_low.y), std::min(low.z, other_low.z),
           0.0f};
    high = {std::max(high.x, other_high.x), std::max(high.y, other_high.y),
            std::max(high.z, other_high.z), 0.0f};
}

/// Boxes around those from begin[b] to begin[b + 1].
inline void enclose(Boxes& boxes, int count, const Buffer<int>& begin, const Boxes& children) {
    for (int b = 0; b < count; ++b) {
        make_empty(boxes.low[at(b)], boxes.high[at(b)]);
        for (int k = begin[at(b)]; k < begin[at(b + 1)]; ++k) {
            include(boxes.low[at(b)], boxes.high[at(b)], children.low[at(k)], children.high[at(k)]);
        }
    }
}

/// Rows to be filled, with too little room in some.
struct Table {
    Buffer<int>& rows;
    Buffer<int>& counts;
    Buffer<int>& needs;
    Buffer<int>& others;

    Table(KernelCase& c, const std::string& name, int items, int room)
        : rows(c.add<int>(name + ".rows", 2 * items)),
          counts(c.add<int>(name + ".counts", items)),
          needs(c.add<int>(name + ".needs", items)),
          others(c.add<int>(name + ".others", (items + 8) * room + 8)) {
        Buffer<int> begin("strips", 2);
        begin[1] = items;
        RowTable table("table", {&begin, 0, 1, 1}, room);
        std::copy_n(table.rows().data(), rows.count(), rows.data());
        for (int& other : others.span()) other = -1;
        for (int& count : counts.span()) count = 7;
        for (int& need : needs.span()) need = c.random.integer(0, 6);
    }

    /// The first rows, with none to four numbers below that, ascending, of which the last one may
    /// be there twice.
    void fill(KernelCase& c, int items) {
        for (int i = 0; i < items; ++i) {
            counts[at(i)] = c.random.integer(0, 4);
            for (int k = 0; k < counts[at(i)]; ++k) {
                others[at(rows[at(i)] + RowTable::kStride * k)] = std::min(i + 2 * k, items - 1);
            }
        }
    }
};

/// Items in patches of 1 to 5, each with some patches near to it.
struct Patches {
    int count = 0;
    Buffer<int>& of_item;
    Table near;
    Boxes boxes;

    explicit Patches(KernelCase& c)
        : of_item(c.add<int>("patches", c.items)),
          near(c, "near", c.items, 4),
          boxes(c, "patches", c.items, 1.0f) {
        for (int i = 0, left = 0; i < c.items; ++i) {
            if (left-- == 0) {
                left = c.random.integer(0, 4);
                ++count;
            }
            of_item[at(i)] = count - 1;
        }
        near.fill(c, count);
    }
};

}  // namespace weft::test
