// Where bodies are, and what is missing of their momentum, against double precision; and what they
// do about it.

#include "kernels/bodies/moments.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "kernels/bodies/free_bodies.h"
#include "kernels/contact/bodies.h"
#include "tests/kernels/random.h"
#include "tests/kernels/run_on_host.h"

namespace weft::test {
namespace {

using namespace kernels;

Eigen::Vector3d in_double(float4 v) { return {v.x, v.y, v.z}; }
Eigen::Vector3d in_double(real3 v) { return {v.x, v.y, v.z}; }

/// A body of some vertices, one after the other in the columns of one run.
struct Cloud {
    static constexpr int kColumns = WEFT_RUN_COLUMNS;
    int count;
    Buffer<float4> positions, targets, previous, unpushed;
    Buffer<int> members{"members", kColumns}, rows{"rows", 2 * kColumns},
        origins{"origins", kColumns}, first_run{"first_run", 1},
        starts{"starts", WEFT_MOMENT_PARTS}, places{"places", WEFT_MOMENT_PARTS};
    Buffer<float> shares{"shares", kColumns}, counts{"counts", 1};
    Buffer<float4> partials{"partials", WEFT_MOMENT_PARTS*kColumns},
        sums{"sums", 2 * WEFT_MOMENT_PARTS}, table{"moments", 2 * WEFT_MOMENT_PARTS};

    explicit Cloud(int vertices)
        : count(vertices),
          positions("positions", static_cast<std::size_t>(vertices)),
          targets("targets", positions.count()),
          previous("previous", positions.count()),
          unpushed("unpushed", positions.count()) {
        counts[0] = 1.0f;
        for (int part = 0; part < WEFT_MOMENT_PARTS; ++part) {
            starts[static_cast<std::size_t>(part)] = kColumns * part;
            places[static_cast<std::size_t>(part)] = part;
        }
        for (int c = 0; c < kColumns; ++c) {
            const auto k = static_cast<std::size_t>(c);
            members[k] = c < count ? c : 0;
            shares[k] = c < count ? 1.0f / static_cast<float>(count) : 0.0f;
            rows[2 * k] = c;
            rows[2 * k + 1] = 1;
        }
    }

    static void run(const Launch& launched, int items) {
        run_on_host(launched, launched.kernel->scalar, 0, items);
    }

    moments weigh() {
        run(launch(kernels::add_moments, Segments{}, positions, targets, previous, unpushed,
                   members, shares, rows, origins, partials, 1, kColumns),
            kColumns);
        run(launch(kernels::add_columns, Segments{}, partials, starts, places, sums),
            WEFT_MOMENT_PARTS);
        run(launch(kernels::weigh_bodies, Segments{}, sums, first_run, counts, table, 1, 1), 1);
        return gather_moments(table.data(), 2, 0);
    }

    Eigen::Vector3d centre() const {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (const float4& x : positions.span()) sum += in_double(x) / count;
        return sum;
    }

    /// The mean of (R r) x (x~ - c - R r), of the rotation by a turn.
    Eigen::Vector3d angular_lag(real3 turn) const {
        const double size = in_double(turn).norm();
        Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
        if (size > 0.0) {
            rotation = Eigen::AngleAxisd(2.0 * std::atan(0.5 * size), in_double(turn) / size)
                           .toRotationMatrix();
        }
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (std::size_t v = 0; v < positions.count(); ++v) {
            const Eigen::Vector3d r = rotation * (in_double(positions[v]) - centre());
            sum += r.cross(in_double(targets[v]) - centre() - r) / count;
        }
        return sum;
    }
};

/// Far from the origin, and should have turned a little.
struct Heap : Cloud {
    Heap() : Cloud(20) {
        Random random(1);
        for (std::size_t v = 0; v < positions.count(); ++v) {
            const float4 r = random.point(0.1f);
            positions[v] = {3.0f + r.x, 2.0f + r.y, -1.0f + r.z, 1.0f};
            targets[v] = {3.001f + r.x + 0.01f * r.y, 2.0f + r.y - 0.01f * r.x,
                          -1.0f + r.z + 0.003f * r.x, 0.0f};
        }
    }
};

TEST(BodyMoments, AreAboutTheCentreOfMass) {
    Heap cloud;
    const moments found = cloud.weigh();
    EXPECT_LT((in_double(found.centre) - cloud.centre()).norm(), 1e-6);
    EXPECT_LT((in_double(lag_of_turn(found, make3(0, 0, 0))) - cloud.angular_lag({})).norm(), 1e-9);
    double inertia = 0.0;
    for (const float4& x : cloud.positions.span()) {
        const Eigen::Vector3d r = in_double(x) - cloud.centre();
        inertia += (r.x() * r.x() + r.y() * r.y()) / cloud.count;
    }
    EXPECT_NEAR(inertia_of(found).zz, inertia, 1e-4 * inertia);
}

TEST(BodyMoments, TellWhatIsLeftOfABodyThatIsTurned) {
    Heap cloud;
    const moments found = cloud.weigh();
    for (const real3 turn : {make3(0.01f, 0.0f, 0.0f), make3(-0.1f, 0.2f, 0.3f)}) {
        const Eigen::Vector3d expected = cloud.angular_lag(turn);
        EXPECT_LT((in_double(lag_of_turn(found, turn)) - expected).norm(), 1e-3 * expected.norm());
    }
}

/// What bears it has pushed five of its vertices, by a mean of 0.01; x~ leads it by `lag`, and it
/// has gone `way`.
borne_lag borne(real3 lag, real3 way) {
    Heap cloud;
    for (std::size_t v = 0; v < cloud.positions.count(); ++v) {
        const float4 x = cloud.positions[v];
        const bool is_pushed = v < 5;
        float4& target = cloud.targets[v];
        if (is_pushed) target.w = 1e-6f;
        cloud.unpushed[v] = {target.x, target.y - (is_pushed ? 0.04f : 0.0f), target.z, 0.0f};
        cloud.previous[v] = is_pushed ? x : float4{x.x - way.x, x.y - way.y, x.z - way.z, x.w};
    }
    return without_throw(lag, cloud.weigh(), make3(0.0f, 0.0f, 0.0f));
}

void expect_lag(const borne_lag& found, double x, double y, double share) {
    EXPECT_LT((in_double(found.lag) - Eigen::Vector3d(x, y, 0.0)).norm(), 1e-6);
    EXPECT_NEAR(found.share, share, 1e-4);
}

TEST(BodyMoments, WhatBearsABodyDoesNotThrowIt) {
    const real3 still = make3(0.0f, 0.0f, 0.0f);
    expect_lag(borne(make3(0.002f, 0.004f, 0.0f), still), 0.002, 0.0, 0.4);
    expect_lag(borne(make3(0.002f, -0.004f, 0.0f), still), 0.002, -0.004, 0.0);
    // No more is taken than it has been pushed.
    expect_lag(borne(make3(0.0f, 0.014f, 0.0f), still), 0.0, 0.004, 1.0);
}

/// Three quarters of the vertices have gone down by 0.004.
TEST(BodyMoments, WhatFallsOntoSomethingIsBraked) {
    const real3 down = make3(0.0f, -0.004f, 0.0f);
    expect_lag(borne(make3(0.0f, 0.002f, 0.0f), down), 0.0, 0.002, 0.0);
    expect_lag(borne(make3(0.0f, 0.005f, 0.0f), down), 0.0, 0.003, 0.2);
}

/// What is left out of the pushes turns nothing, either.
TEST(BodyMoments, TellHowPushesTurn) {
    Heap cloud;
    Random random(7);
    for (std::size_t v = 0; v < cloud.positions.count(); ++v) {
        const float4 push = random.point(0.01f), target = cloud.targets[v];
        cloud.unpushed[v] = {target.x - push.x, target.y - push.y, target.z - push.z, 0.0f};
    }
    Eigen::Vector3d torque = Eigen::Vector3d::Zero();
    for (std::size_t v = 0; v < cloud.positions.count(); ++v) {
        const Eigen::Vector3d r = in_double(cloud.positions[v]) - cloud.centre();
        torque += r.cross(in_double(cloud.targets[v]) - in_double(cloud.unpushed[v])) / cloud.count;
    }
    EXPECT_LT((in_double(cloud.weigh().torque) - torque).norm(), 1e-3 * torque.norm());
}

/// What hangs from what it drapes over would turn it.
TEST(BodyMoments, WhatIsPushedIsNotTurned) {
    Heap heap;
    for (std::size_t v = 0; v < heap.positions.count(); ++v) {
        heap.previous[v] = heap.positions[v];
        heap.unpushed[v] = heap.targets[v];
    }
    ASSERT_GT(length3(missing_motion(heap.weigh(), {make3(0.0f, 0.0f, 0.0f), 0.0f}, 0.0f).turn),
              1e-3f);
    heap.unpushed[0].y -= 1e-3f;
    heap.targets[0].w = 1e-9f;
    const moments found = heap.weigh();
    EXPECT_GT(found.pushed, 0.0f);
    const body_motion motion = missing_motion(found, {make3(0.001f, 0.0f, 0.002f), 0.0f}, 0.0f);
    EXPECT_EQ(length3(motion.turn), 0.0f);
    EXPECT_EQ(motion.shift.x, 0.001f);
    EXPECT_EQ(motion.shift.z, 0.002f);
}

/// Pushed at one end: by a contact of that normal there.
body_motion push_end(Cloud& cloud, real3 normal) {
    const moments body = cloud.weigh();
    Buffer<float4> lags("lags", 2 * WEFT_BODY_PARTS), rests("rests", 7), motions("motions", 4),
        strains("strains", 4), bearings("bearings", 2 * WEFT_BEARING_PARTS);
    Buffer<float> masses("masses", 1);
    masses[0] = 1.0f;
    const real3 lever = subtract(xyz(gather4(cloud.positions.data(), 0)), body.centre);
    const sym6 form = form_at_lever(outer_sym(normal, 10.0f), lever);
    const item first = {0, 1};
    store_sym6(lags.data(), 2, first, form);
    const real3 force = scale(normal, 1e-3f);
    store4(lags.data(), column(first, 2, 5), with_w(force, form.mixed.z.z));
    store4(lags.data(), column(first, 2, 6), with_w(cross3(lever, force), 0.0f));
    Cloud::run(
        launch(kernels::solve_bodies, Segments{}, lags, cloud.first_run, cloud.counts, masses,
               cloud.table, motions, strains, rests, bearings, 0, 0, 1, 1, 2, 1, 0.0f),
        1);
    for (const float4& rest : rests.span()) EXPECT_TRUE(std::isfinite(rest.x + rest.y + rest.z));
    return gather_motion(motions.data(), 2, 0);
}

/// Nothing turns about the line on which all of it lies.
TEST(BodyMoments, ALineTurnsAcrossItselfOnly) {
    Cloud cloud(7);
    for (std::size_t v = 0; v < cloud.positions.count(); ++v) {
        const float along = 0.01f * static_cast<float>(v);
        cloud.positions[v] = {1.0f + 2.0f * along, 3.0f * along, -1.0f - along, 1.0f};
        cloud.targets[v] = cloud.positions[v];
    }
    const body_motion found = push_end(cloud, make3(0.0f, 0.6f, 0.8f));
    const real3 line = scale(make3(2.0f, 3.0f, -1.0f), 1.0f / std::sqrt(14.0f));
    EXPECT_GT(length3(found.turn), 1e-4f);
    EXPECT_LT(std::abs(dot3(found.turn, line)), 0.05f * length3(found.turn));
}

TEST(BodyMoments, APointIsShiftedOnly) {
    for (const int count : {1, 5}) {
        Cloud cloud(count);
        for (std::size_t v = 0; v < cloud.positions.count(); ++v) {
            cloud.positions[v] = {0.3f, -0.7f, 1.9f, 1.0f};
            cloud.targets[v] = cloud.positions[v];
        }
        const body_motion found = push_end(cloud, make3(0.0f, 1.0f, 0.0f));
        EXPECT_NEAR(found.shift.y, 1e-3f / 11.0f, 1e-8f) << count;
        EXPECT_LT(length3(found.turn), 0.51f);
    }
}

}  // namespace
}  // namespace weft::test
