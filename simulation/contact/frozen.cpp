#include "simulation/families/in_double.h"
// The language layer in double precision has to come before all else.
#include "kernels/contact/energy.h"

#include "simulation/contact/frozen.h"
#include "simulation/families/convert.h"

namespace weft {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

FrozenContact contact_at(const ContactRows& rows, std::size_t entry) {
    const float4& n = rows.normals[entry];
    const float4& w = rows.weights[entry];
    const float4& m = rows.measures[entry];
    return {{rows.corner0[entry], rows.corner1[entry], rows.corner2[entry], rows.corner3[entry]},
            {double{w.x}, double{w.y}, double{w.z}, double{w.w}},
            to_vec3(n),
            double{m.w},
            double{m.z}};
}

/// The first of its vertices that has an entry of it.
int owner_of(const FrozenContact& contact, std::span<const float4> positions) {
    for (std::size_t k = 0; k < 3; ++k) {
        const int v = contact.corners[k];
        if (contact.weights[k] != 0.0 && positions[at(v)].w > 0.0f) return v;
    }
    return contact.corners[3];
}

}  // namespace

/// As the kernels do it: what all corners have in common is far larger than the gap.
double FrozenContact::gap(std::span<const Vec3> x) const {
    const Vec3 first = x[at(corners[0])];
    double sum = 0.0;
    for (std::size_t k = 1; k < 4; ++k) sum += weights[k] * dot(normal, x[at(corners[k])] - first);
    return sum;
}

double FrozenContact::energy(double gap) const {
    return kernels::contact_energy(gap, range, stiffness);
}
double FrozenContact::slope(double gap) const {
    return kernels::contact_slope(gap, range, stiffness);
}
/// None beyond the range, where the kernels' is that of what may come.
double FrozenContact::curvature(double gap) const {
    return gap < range ? kernels::contact_curvature(gap, range, stiffness) : 0.0;
}

std::vector<FrozenContact> frozen_contacts(const ContactRows& rows,
                                           std::span<const float4> positions) {
    std::vector<FrozenContact> contacts;
    for (int v = 0; v < rows.table.item_count(); ++v) {
        const int start = rows.table.rows()[at(v)];
        for (int k = 0; k < rows.table.counts()[at(v)]; ++k) {
            const FrozenContact found = contact_at(rows, at(start + RowTable::kStride * k));
            if (owner_of(found, positions) == v) contacts.push_back(found);
        }
    }
    return contacts;
}

}  // namespace weft
