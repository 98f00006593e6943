// What contacts do to vertices, against what their energy says: forces by differences, energies one
// contact at a time, and where XPBD's projections end.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "kernels/contact/terms.h"
#include "kernels/xpbd/contacts.h"
#include "runtime/row_table.h"
#include "simulation/families/convert.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

constexpr float kRange = 0.1f;
constexpr int kVertices = 20;
constexpr int kHeld = 4;
constexpr int kContacts = 24;
constexpr double kInverseH2 = 1e4;
constexpr float kSlow = 0.05f;  ///< the way below which friction sticks [m]

std::size_t at(int i) { return static_cast<std::size_t>(i); }

struct TestContact {
    std::array<int, 4> corners;
    std::array<float, 4> weights;
    float4 normal;
    float stiffness;
};

/// E as energy.h states it, in double precision [J].
double energy_of(double gap, double k) {
    const double r = double{kRange};
    const double tau = 0.5 * r;
    if (gap >= r) return 0.0;
    if (gap >= tau) return 0.5 * k * (r - gap) * (r - gap);
    return 0.5 * k * tau * tau * (1.0 + tau / gap - gap / tau);
}

/// Some vertices, the first ones held, in contacts of all kinds.
class TouchingVertices {
public:
    TouchingVertices(unsigned seed, int held)
        : positions("positions", kVertices),
          held_(held),
          random_(seed),
          begin_("strips", 2),
          table_("contacts", segments(), kContacts),
          corners_{&table_.add_column<int>("corner0"), &table_.add_column<int>("corner1"),
                   &table_.add_column<int>("corner2"), &table_.add_column<int>("corner3")},
          normals_(table_.add_column<float4>("normals")),
          weights_(table_.add_column<float4>("weights")),
          measures_(table_.add_column<float4>("measures")),
          slips_(table_.add_column<float4>("slips")),
          multipliers_(table_.add_column<float>("multipliers")),
          rubs_(table_.add_column<float4>("rubs")),
          snapshots_("snapshots", 2 * kVertices) {
        for (int v = 0; v < kVertices; ++v) {
            positions[at(v)] = random_.point(0.04f);
            positions[at(v)].w = is_free(v) ? random_.real(0.5f, 2.0f) : 0.0f;
        }
        for (int c = 0; c < kContacts; ++c) add_contact(c % 4);
    }

    bool is_free(int vertex) const { return vertex >= held_; }
    /// Whether it moves by the contact.
    bool takes_part(const TestContact& c, std::size_t corner) const {
        return is_free(c.corners[corner]) && c.weights[corner] != 0.0f;
    }

    /// [J], by the kernel.
    double energy() {
        Buffer<int> slots("slots", kVertices);
        for (int v = 0; v < kVertices; ++v) slots[at(v)] = v;
        Buffer<float> terms("terms", kVertices);
        const Launch sum = launch(kernels::contact_terms, Segments{}, positions, table_.rows(),
                                  table_.counts(), *corners_[0], *corners_[1], *corners_[2],
                                  *corners_[3], normals_, weights_, measures_, slots, terms);
        run_on_host(sum, sum.kernel->scalar, 0, kVertices);
        double energy = 0.0;
        for (const float term : terms.span()) energy += double{term};
        return energy;
    }

    /// dE/dx of the contacts alone, at the positions as their snapshot [N]; with what rubs there.
    std::vector<Vec3> gradient(float friction = 0.0f) {
        Buffer<int> vertices("vertices", kVertices);
        for (int v = 0; v < kVertices; ++v) vertices[at(v)] = v;
        Buffer<float> sums("sums", 9 * kVertices);
        const Launch gather = launch(
            kernels::gather_contacts, Segments{}, positions, positions, vertices, table_.rows(),
            table_.counts(), *corners_[0], *corners_[1], *corners_[2], *corners_[3], normals_,
            weights_, measures_, slips_, sums, kVertices, 0, kIteration, friction, kSlow);
        run_on_host(gather, gather.kernel->scalar, 0, kVertices);
        std::vector<Vec3> gradient;
        for (std::size_t v = 0; v < kVertices; ++v) {
            gradient.push_back({sums[v], sums[v + kVertices], sums[v + 2 * kVertices]});
        }
        return gradient;
    }

    /// One iteration of XPBD without any elements.
    void project(int iteration, float friction = 0.0f) {
        const Launch share =
            launch(kernels::share_masses, Segments{}, positions, table_.rows(), table_.counts(),
                   measures_, least_, snapshots_, kVertices, kIteration, 0);
        run_on_host(share, share.kernel->scalar, 0, kVertices, 0, iteration);
        const Launch push =
            launch(kernels::project_contacts, Segments{}, positions, snapshots_, table_.rows(),
                   table_.counts(), *corners_[0], *corners_[1], *corners_[2], *corners_[3],
                   normals_, weights_, measures_, multipliers_, kVertices,
                   static_cast<float>(kInverseH2), kIteration);
        run_on_host(push, push.kernel->scalar, 0, kVertices, 0, iteration);
        if (friction == 0.0f) return;
        const Launch rub = launch(kernels::rub_contacts, Segments{}, positions, snapshots_,
                                  table_.rows(), table_.counts(), *corners_[0], *corners_[1],
                                  *corners_[2], *corners_[3], normals_, weights_, measures_, slips_,
                                  multipliers_, rubs_, kVertices, kIteration, friction, kSlow);
        run_on_host(rub, rub.kernel->scalar, 0, kVertices, 0, iteration);
    }

    /// By how much lighter an iteration takes a vertex for a contact of weight 1 than it is.
    double crowd(int v, int iteration) const {
        const std::size_t shown = at(v + iteration % 2 * kVertices);
        return double{snapshots_[shown].w} / double{positions[at(v)].w};
    }

    double gap(const TestContact& c) const {
        Vec3 way;
        for (std::size_t k = 0; k < 4; ++k) {
            way = way + double{c.weights[k]} * to_vec3(positions[at(c.corners[k])]);
        }
        return dot(to_vec3(c.normal), way);
    }

    Buffer<float4> positions;
    std::vector<TestContact> contacts;

private:
    Segments segments() {
        begin_[1] = kVertices;
        return {&begin_, 0, 1, 1};
    }

    /// kind  0: a vertex and a triangle, 1: two edges, 2: a vertex and an edge, 3: two vertices
    TestContact random_contact(int kind) {
        TestContact c;
        const auto order = random_.permutation(kVertices);
        std::copy_n(order.begin(), 4, c.corners.begin());
        const float u = random_.real(0.2f, 0.4f);
        const float v = random_.real(0.2f, 0.4f);
        if (kind == 0) c.weights = {1.0f, -u, -v, u + v - 1.0f};
        if (kind == 1) c.weights = {1.0f - u, u, v - 1.0f, -v};
        if (kind == 2) c.weights = {1.0f, u - 1.0f, -u, 0.0f};
        if (kind == 3) c.weights = {1.0f, 0.0f, 0.0f, -1.0f};
        c.normal = to_float4(normalized(to_vec3(random_.point(1.0f))));
        c.stiffness = random_.real(1e4f, 4e4f);
        return c;
    }

    void add_contact(int kind) {
        TestContact c = random_contact(kind);
        while (gap(c) < 0.1 * double{kRange}) c = random_contact(kind);
        contacts.push_back(c);
        for (std::size_t k = 0; k < 4; ++k) {
            const bool is_first = k == 0 || (k == 1 && kind == 1);
            if (takes_part(c, k)) add_entry(c, k, is_first ? 1.0f : -1.0f);
        }
    }

    /// side: 1 for the first surface, -1 for the other one
    void add_entry(const TestContact& c, std::size_t corner, float side) {
        const std::size_t vertex = at(c.corners[corner]);
        const std::size_t place =
            at(table_.rows()[vertex] + RowTable::kStride * table_.counts()[vertex]++);
        float spread = 0.0f;
        for (std::size_t k = 0; k < 4; ++k) {
            (*corners_[k])[place] = c.corners[k];
            if (takes_part(c, k)) spread += std::abs(c.weights[k]);
        }
        const float own = std::abs(c.weights[corner]);
        normals_[place] = {side * c.normal.x, side * c.normal.y, side * c.normal.z,
                           static_cast<float>(gap(c))};
        weights_[place] = {side * c.weights[0], side * c.weights[1], side * c.weights[2],
                           side * c.weights[3]};
        measures_[place] = {own, own * spread, c.stiffness, kRange};
    }

    int held_;
    Random random_;
    Buffer<int> begin_;
    RowTable table_;
    std::array<Buffer<int>*, 4> corners_;
    Buffer<float4>&normals_, &weights_, &measures_, &slips_;
    Buffer<float>& multipliers_;
    Buffer<float4>& rubs_;
    Buffer<float4> snapshots_;
    Buffer<float> least_{"least", kVertices};  ///< 0: all may have contacts
};

TEST(ContactRows, EachContactHasItsEnergyOnce) {
    TouchingVertices touching(3, kHeld);
    double expected = 0.0;
    int counted = 0;
    for (const TestContact& c : touching.contacts) {
        bool is_free = false;
        for (std::size_t k = 0; k < 4; ++k) is_free = is_free || touching.takes_part(c, k);
        if (!is_free) continue;
        expected += energy_of(touching.gap(c), double{c.stiffness});
        ++counted;
    }
    ASSERT_GT(counted, kContacts / 2);
    EXPECT_NEAR(touching.energy(), expected, 1e-5 * expected);
}

TEST(ContactRows, TheForceIsTheEnergysSlope) {
    TouchingVertices touching(4, kHeld);
    const auto gradient = touching.gradient();
    double largest = 0.0;
    for (const Vec3& g : gradient) largest = std::max(largest, length(g));
    for (int v = kHeld; v < kVertices; ++v) {
        constexpr float kStep = 1e-4f;
        const auto slope = [&](float float4::*axis) {
            float4& x = touching.positions[at(v)];
            const float here = x.*axis;
            x.*axis = here + kStep;
            const double above = touching.energy();
            x.*axis = here - kStep;
            const double below = touching.energy();
            const double way = double{here + kStep} - double{here - kStep};
            x.*axis = here;
            return (above - below) / way;
        };
        EXPECT_NEAR(slope(&float4::x), gradient[at(v)].x, 1e-3 * largest) << v;
        EXPECT_NEAR(slope(&float4::y), gradient[at(v)].y, 1e-3 * largest) << v;
        EXPECT_NEAR(slope(&float4::z), gradient[at(v)].z, 1e-3 * largest) << v;
    }
}

/// Where the inertia that pulls back to the start and the forces of contacts are equal: at the
/// minimum of the energy that the other solvers minimise. With friction, where their forces of
/// friction are in balance with both.
TEST(ContactProjection, EndsAtTheMinimumOfTheStepsEnergy) {
    for (const auto& [seed, friction] :
         {std::pair(5U, 0.0f), {6U, 0.0f}, {7U, 0.0f}, {5U, 0.3f}, {6U, 0.3f}, {7U, 0.3f}}) {
        TouchingVertices touching(seed, kHeld);
        std::vector<Vec3> start;
        for (const float4& x : touching.positions.span()) start.push_back(to_vec3(x));
        for (int iteration = 0; iteration < 2000; ++iteration) {
            touching.project(iteration, friction);
        }
        const auto gradient = touching.gradient(friction);
        double moved = 0.0;
        for (int v = kHeld; v < kVertices; ++v) {
            const float4& x = touching.positions[at(v)];
            const Vec3 inertia = (kInverseH2 / double{x.w}) * (to_vec3(x) - start[at(v)]);
            moved = std::max(moved, length(inertia));
            EXPECT_LT(length(inertia + gradient[at(v)]), 1e-2) << "N at vertex " << v;
        }
        EXPECT_GT(moved, 10.0) << "N";
        for (int v = 0; v < kHeld; ++v) EXPECT_EQ(to_vec3(touching.positions[at(v)]), start[at(v)]);
    }
}

Vec3 momentum(const Buffer<float4>& positions) {
    Vec3 sum;
    for (const float4& x : positions.span()) sum = sum + (1.0 / double{x.w}) * to_vec3(x);
    return sum;
}

double weight_at(const TestContact& c, int v) {
    double weight = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
        if (c.corners[k] == v) weight += std::abs(double{c.weights[k]});
    }
    return weight;
}

/// Each gets of its vertices' masses what its weight is of all weights: of all contacts at first,
/// then of those that pressed.
TEST(ContactProjection, WhatDoesNotPressLeavesTheMassToWhatDoes) {
    TouchingVertices touching(8, kHeld);
    for (float4& x : touching.positions.span()) x = {3.0f * x.x, 3.0f * x.y, 3.0f * x.z, x.w};
    std::vector<double> all(kVertices, 0.0);
    std::vector<double> pressing(kVertices, 0.0);
    for (const TestContact& c : touching.contacts) {
        const bool presses = touching.gap(c) < double{kRange};
        for (int v = kHeld; v < kVertices; ++v) {
            all[at(v)] += weight_at(c, v);
            if (presses) pressing[at(v)] += weight_at(c, v);
        }
    }
    touching.project(0);
    for (int v = kHeld; v < kVertices; ++v) {
        EXPECT_NEAR(touching.crowd(v, 0), all[at(v)], 1e-5) << v;
        EXPECT_NEAR(touching.crowd(v, 1), std::max(pressing[at(v)], 1.0), 1e-5) << v;
    }
    EXPECT_LT(std::accumulate(pressing.begin(), pressing.end(), 0.0),
              0.8 * std::accumulate(all.begin(), all.end(), 0.0));
}

TEST(ContactProjection, WhatOneVertexGetsTheOthersGive) {
    for (const float friction : {0.0f, 0.5f}) {
        TouchingVertices touching(8, 0);
        const Vec3 before = momentum(touching.positions);
        for (int iteration = 0; iteration < 5; ++iteration) {
            touching.project(iteration, friction);
            EXPECT_LT(length(momentum(touching.positions) - before), 1e-6) << iteration;
        }
    }
}

}  // namespace
}  // namespace weft::test
