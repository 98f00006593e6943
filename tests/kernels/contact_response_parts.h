#pragma once

// What cases of contact's response are made of.

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/row_table.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test::response {

inline constexpr float kSize = 0.3f;
inline constexpr float kRange = 0.1f;
inline constexpr int kRoom = 6;
inline constexpr int kBodies = 4;
inline constexpr int kSubsteps = 8;

inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Points of which some are held; degenerate: many in one place.
inline Buffer<float4>& add_points(KernelCase& c, const std::string& name, int count) {
    auto& points = c.add<float4>(name, count);
    for (float4& x : points.span()) {
        x = c.random.point(kSize);
        if (c.flavour == Flavour::kDegenerate && c.random.integer(0, 1) == 0) x = points[0];
        x.w = c.random.integer(0, 5) == 0 ? 0.0f : c.random.real(0.5f, 2.0f);
    }
    return points;
}

inline Buffer<int>& add_indices(KernelCase& c, const std::string& name, int count, int end) {
    auto& indices = c.add<int>(name, count);
    for (int& index : indices.span()) index = c.random.integer(0, end - 1);
    return indices;
}

/// The rows of a table as RowTable places them, of all lengths.
struct Rows {
    Buffer<int>& rows;
    Buffer<int>& counts;
    int entries = 0;

    Rows(KernelCase& c, const std::string& name, int items, int room)
        : rows(c.add<int>(name + ".rows", 2 * items)), counts(c.add<int>(name + ".counts", items)) {
        Buffer<int> begin("strips", 2);
        begin[1] = items;
        RowTable table("table", {&begin, 0, 1, 1}, room);
        std::copy_n(table.rows().data(), rows.count(), rows.data());
        entries = static_cast<int>(table.add_column<int>("others").count());
        for (int& count : counts.span()) count = c.random.integer(0, c.random.integer(0, room));
    }
};

inline Buffer<float4>& add_normals(KernelCase& c, const std::string& name, int count, float low,
                                   float high) {
    auto& normals = c.add<float4>(name, count);
    for (float4& n : normals.span()) {
        n = c.random.point(1.0f);
        const float size = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z) + 1e-6f;
        n = {n.x / size, n.y / size, n.z / size, c.random.real(low, high)};
    }
    return normals;
}

/// Rows of planes before vertices, and how far each is from the nearest one.
struct Planes : Rows {
    Buffer<float4>& all;
    Buffer<float>& least;

    explicit Planes(KernelCase& c)
        : Rows(c, "planes", c.items, kRoom),
          all(add_normals(c, "planes", entries, c.flavour == Flavour::kRandom ? 0.0f : -0.1f,
                          0.2f)),
          least(c.add<float>("least", c.items)) {
        for (int v = 0; v < c.items; ++v) {
            least[at(v)] = 1e30f;
            for (int k = 0; k < counts[at(v)]; ++k) {
                const float4& plane = all[at(rows[at(v)] + RowTable::kStride * k)];
                least[at(v)] = std::min(least[at(v)], plane.w);
            }
        }
    }
};

struct Contacts {
    Rows rows;
    Buffer<int>&corner0, &corner1, &corner2, &corner3;
    Buffer<float4>&normals, &weights, &measures, &slips;

    explicit Contacts(KernelCase& c)
        : rows(c, "contacts", c.items, kRoom),
          corner0(add_indices(c, "corner0", rows.entries, c.items)),
          corner1(add_indices(c, "corner1", rows.entries, c.items)),
          corner2(add_indices(c, "corner2", rows.entries, c.items)),
          corner3(add_indices(c, "corner3", rows.entries, c.items)),
          normals(add_normals(c, "normals", rows.entries, -kRange, 2.0f * kRange)),
          weights(c.add<float4>("weights", rows.entries)),
          measures(c.add<float4>("measures", rows.entries)),
          slips(add_points(c, "earlier_slips", rows.entries)) {
        for (std::size_t e = 0; e < weights.count(); ++e) {
            const float u = c.random.real(0.0f, 0.5f);
            const float v = c.random.real(0.0f, 0.5f);
            weights[e] = {1.0f, -u, -v, u + v - 1.0f};
            measures[e] = {u, 2.0f * u, c.random.real(1.0f, 1e4f), kRange};
        }
    }
};

/// What kernels over the rows of all vertices take; each vertex is a corner of its contacts.
struct OwnContacts : Contacts {
    Buffer<float4>& positions;

    explicit OwnContacts(KernelCase& c)
        : Contacts(c), positions(add_points(c, "positions", c.items)) {
        const std::array corners{&corner0, &corner1, &corner2, &corner3};
        for (int v = 0; v < c.items; ++v) {
            for (int k = 0; k < rows.counts[at(v)]; ++k) {
                auto& corner = *corners[at(c.random.integer(0, 3))];
                corner[at(rows.rows[at(v)] + RowTable::kStride * k)] = v;
            }
        }
        if (c.flavour == Flavour::kRandom) return;
        for (float4& w : weights.span()) {
            if (c.random.integer(0, 2) == 0) w = {0.0f, 1.0f, w.z, w.w};
        }
    }
};

}  // namespace weft::test::response
