#include "simulation/families/in_double.h"
// The language layer in double precision has to come before all else.
#include "kernels/contact/energy.h"
#include "kernels/contact/friction.h"

#include <algorithm>
#include <cmath>

#include "simulation/contact/frozen.h"
#include "simulation/families/convert.h"

namespace weft {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

FrozenContact contact_at(const ContactRows& rows, std::size_t entry, Rubbing rubbing) {
    const float4& n = rows.normals[entry];
    const float4& w = rows.weights[entry];
    const float4& m = rows.measures[entry];
    return {{rows.corner0[entry], rows.corner1[entry], rows.corner2[entry], rows.corner3[entry]},
            {double{w.x}, double{w.y}, double{w.z}, double{w.w}},
            to_vec3(n),
            double{m.w},
            double{m.z},
            rubbing,
            rows.have_slips() ? to_vec3(rows.slips[entry]) : Vec3{}};
}

/// Whether one of its corners has an entry of it.
bool has_entry(const FrozenContact& contact, std::size_t corner,
               std::span<const float4> positions) {
    return contact.weights[corner] != 0.0 && positions[at(contact.corners[corner])].w > 0.0f;
}

/// The first of its vertices that has an entry of it.
int owner_of(const FrozenContact& contact, std::span<const float4> positions) {
    for (std::size_t k = 0; k < 3; ++k) {
        if (has_entry(contact, k, positions)) return contact.corners[k];
    }
    return contact.corners[3];
}

Mat3 outer(Vec3 a, double factor) {
    return {{(factor * a.x) * a, (factor * a.y) * a, (factor * a.z) * a}};
}

/// As the kernels do it: what all corners have in common is far larger than the gap.
template <class Place>
Vec3 way_between(const FrozenContact& contact, Place place) {
    const Vec3 first = place(contact.corners[0]);
    Vec3 sum;
    for (std::size_t k = 1; k < 4; ++k) {
        sum = sum + contact.weights[k] * (place(contact.corners[k]) - first);
    }
    return sum;
}

void make_room(const ContactRows& rows, std::span<const FrozenContact> contacts,
               std::span<const float4> positions) {
    Buffer<int>& needs = rows.table.needs();
    std::ranges::fill(needs.span(), 0);
    for (const FrozenContact& c : contacts) {
        for (std::size_t k = 0; k < 4; ++k) {
            if (has_entry(c, k, positions)) ++needs[at(c.corners[k])];
        }
    }
    if (rows.table.overflowed()) rows.table.grow();
}

/// What leads away from the other side is positive.
void put_entry(const ContactRows& rows, std::size_t entry, const FrozenContact& c,
               std::size_t corner, double spread, double ahead) {
    const double side = c.weights[corner] > 0.0 ? 1.0 : -1.0;
    const auto weight = [&](std::size_t k) { return static_cast<float>(side * c.weights[k]); };
    rows.corner0[entry] = c.corners[0];
    rows.corner1[entry] = c.corners[1];
    rows.corner2[entry] = c.corners[2];
    rows.corner3[entry] = c.corners[3];
    rows.normals[entry] = to_float4(side * c.normal, ahead);
    rows.weights[entry] = {weight(0), weight(1), weight(2), weight(3)};
    if (rows.have_slips()) rows.slips[entry] = to_float4(side * c.earlier_slip, 0.0);
    const float own = weight(corner);
    rows.measures[entry] = {own, own * static_cast<float>(spread), static_cast<float>(c.stiffness),
                            static_cast<float>(c.range)};
}

/// What of the way leads along the surface, and what did before.
Vec3 slip_of(const FrozenContact& contact, Vec3 way) {
    return way - contact.gap(way) * contact.normal + contact.earlier_slip;
}

}  // namespace

Vec3 FrozenContact::way(std::span<const Vec3> x) const {
    return way_between(*this, [&](int v) { return x[at(v)]; });
}
Vec3 FrozenContact::way(std::span<const float4> x) const {
    return way_between(*this, [&](int v) { return to_vec3(x[at(v)]); });
}

double FrozenContact::energy(Vec3 way) const {
    const double slip = length(slip_of(*this, way));
    return kernels::contact_energy(gap(way), range, stiffness) +
           rubbing.friction * press * kernels::friction_potential(slip, rubbing.creep);
}

Vec3 FrozenContact::gradient(Vec3 way) const {
    const Vec3 slip = slip_of(*this, way);
    const double grip = kernels::friction_grip(length(slip), rubbing.creep);
    return -force(way) * normal + (rubbing.friction * press * grip) * slip;
}

/// No curvature beyond the range, where the kernels' is that of what may come.
Mat3 FrozenContact::hessian(Vec3 way) const {
    const double g = gap(way);
    const double curvature = g < range ? kernels::contact_curvature(g, range, stiffness) : 0.0;
    const Vec3 slip = slip_of(*this, way);
    const double size = length(slip);
    const double grip = kernels::friction_grip(size, rubbing.creep);
    // d(grip)/d(slip) / slip; what it is made of is 0 where there is no slip.
    const double fall =
        size < rubbing.creep ? 1.0 / (rubbing.creep * rubbing.creep) : 1.0 / (size * size);
    const Vec3 along = size > 0.0 ? (1.0 / size) * slip : Vec3{};
    const Mat3 rubs = grip * (Mat3{} + outer(normal, -1.0)) + outer(along, -fall * size);
    return outer(normal, curvature) + (rubbing.friction * press) * rubs;
}

double FrozenContact::force(Vec3 way) const {
    return -kernels::contact_slope(gap(way), range, stiffness);
}

std::vector<FrozenContact> with_corners(std::vector<FrozenContact> contacts,
                                        std::span<const int> new_of) {
    for (FrozenContact& contact : contacts) {
        for (int& corner : contact.corners) corner = new_of[at(corner)];
    }
    return contacts;
}

std::vector<FrozenContact> frozen_contacts(const ContactRows& rows,
                                           std::span<const float4> positions, Rubbing rubbing) {
    std::vector<FrozenContact> contacts;
    for (int v = 0; v < rows.table.item_count(); ++v) {
        const int start = rows.table.rows()[at(v)];
        for (int k = 0; k < rows.table.counts()[at(v)]; ++k) {
            const FrozenContact found =
                contact_at(rows, at(start + RowTable::kStride * k), rubbing);
            if (owner_of(found, positions) == v) contacts.push_back(found);
        }
    }
    return contacts;
}

void fill_rows(const ContactRows& rows, std::span<const FrozenContact> contacts,
               std::span<const float4> positions, std::span<const float4> targets) {
    make_room(rows, contacts, positions);
    Buffer<int>& counts = rows.table.counts();
    std::ranges::fill(counts.span(), 0);
    for (const FrozenContact& c : contacts) {
        const double ahead = c.gap(c.way(targets));
        double spread = 0.0;
        for (std::size_t k = 0; k < 4; ++k) {
            if (has_entry(c, k, positions)) spread += std::abs(c.weights[k]);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            if (!has_entry(c, k, positions)) continue;
            const auto v = at(c.corners[k]);
            const auto entry = at(rows.table.rows()[v] + RowTable::kStride * counts[v]++);
            put_entry(rows, entry, c, k, spread, ahead);
        }
    }
}

}  // namespace weft
