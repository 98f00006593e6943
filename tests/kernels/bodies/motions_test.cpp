// Motions of bodies as wholes against double precision.

#include "kernels/bodies/motions.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "tests/kernels/random.h"

namespace weft::test {
namespace {

using namespace kernels;

using Form = Eigen::Matrix<double, 6, 6>;
using Motion = Eigen::Matrix<double, 6, 1>;

real3 vector(Random& random, float size) {
    const float4 v = random.point(size);
    return make3(v.x, v.y, v.z);
}

Eigen::Vector3d in_double(real3 v) { return {v.x, v.y, v.z}; }

Motion in_double(body_motion m) {
    Motion v;
    v << in_double(m.shift), in_double(m.turn);
    return v;
}

Eigen::Matrix3d in_double(sym3 a) {
    Eigen::Matrix3d m;
    m << a.xx, a.xy, a.xz, a.xy, a.yy, a.yz, a.xz, a.yz, a.zz;
    return m;
}

Form in_double(sym6 a) {
    Eigen::Matrix3d mixed;
    mixed << in_double(a.mixed.x), in_double(a.mixed.y), in_double(a.mixed.z);
    Form form;
    form << in_double(a.shift), mixed, mixed.transpose(), in_double(a.turn);
    return form;
}

/// What takes motions to ways at a lever.
Eigen::Matrix<double, 3, 6> ways_at(real3 lever) {
    Eigen::Matrix3d cross;
    cross << 0.0, -lever.z, lever.y, lever.z, 0.0, -lever.x, -lever.y, lever.x, 0.0;
    Eigen::Matrix<double, 3, 6> ways;
    ways << Eigen::Matrix3d::Identity(), -cross;
    return ways;
}

/// A brick of a few centimetres that some stiff contacts hold.
sym6 held_body(Random& random) {
    sym6 form = no_sym6();
    form.shift = diagonal_sym(1.0f);
    form.turn = make_sym(2e-3f, 1e-4f, 0.0f, 1e-3f, -1e-4f, 3e-3f);
    for (int k = 0; k < 5; ++k) {
        const real3 normal = scale(vector(random, 1.0f), 3.0f);
        form = add_scaled_sym6(form, form_at_lever(outer_sym(normal, 1.0f), vector(random, 0.1f)),
                               1.0f);
    }
    return form;
}

TEST(BodyMotions, FormsAtALeverAreThoseOfTheWaysThere) {
    Random random(1);
    for (int round = 0; round < 50; ++round) {
        const sym3 stiffness = outer_sym(vector(random, 1.0f), 2.0f);
        const real3 lever = vector(random, 0.5f);
        const auto ways = ways_at(lever);
        const Form expected = ways.transpose() * in_double(stiffness) * ways;
        EXPECT_LT((in_double(form_at_lever(stiffness, lever)) - expected).norm(), 1e-6);
    }
}

TEST(BodyMotions, FormsAboutAnotherCentre) {
    Random random(2);
    for (int round = 0; round < 50; ++round) {
        const sym6 form = held_body(random);
        const real3 lever = vector(random, 0.5f);
        Form moved = Form::Identity();
        moved.topRows(3) = ways_at(lever);
        const Form expected = moved.transpose() * in_double(form) * moved;
        EXPECT_LT((in_double(form_from(form, lever)) - expected).norm(), 1e-5 * expected.norm());
    }
}

TEST(BodyMotions, SolutionsAreThoseOfDoublePrecision) {
    Random random(3);
    for (int round = 0; round < 200; ++round) {
        const sym6 form = held_body(random);
        const body_motion b = make_motion(vector(random, 1e-3f), vector(random, 1e-5f));
        const Motion expected = in_double(form).ldlt().solve(in_double(b));
        EXPECT_LT((in_double(solve_sym6(form, b)) - expected).norm(), 2e-4 * expected.norm());
    }
}

TEST(BodyMotions, TurnsOfAnySizeInflateNothing) {
    Random random(4);
    for (const float size : {1e-6f, 0.01f, 0.5f, 10.0f}) {
        const real3 turn = vector(random, size);
        const real3 lever = vector(random, 0.3f);
        const real3 turned = add(lever, way_of_turn(turn, lever));
        EXPECT_NEAR(length3(turned), length3(lever), 1e-7f);
        const double angle = 2.0 * std::atan(0.5 * in_double(turn).norm());
        const Eigen::AngleAxisd rotation(angle, in_double(turn).normalized());
        EXPECT_LT((in_double(turned) - rotation * in_double(lever)).norm(), 1e-7);
    }
}

TEST(BodyMotions, LongTurnsAreCutShort) {
    EXPECT_FLOAT_EQ(length3(bounded_turn(make3(3.0f, -4.0f, 0.0f))), 0.5f);
    const real3 small = make3(0.1f, 0.2f, -0.3f);
    EXPECT_EQ(bounded_turn(small).z, small.z);
}

}  // namespace
}  // namespace weft::test
