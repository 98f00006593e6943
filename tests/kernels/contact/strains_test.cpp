// Uniform strains of bodies against double precision.

#include "kernels/contact/strains.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "tests/kernels/random.h"

namespace weft::test {
namespace {

using namespace kernels;

real3 vector(Random& random, float size) {
    const float4 v = random.point(size);
    return make3(v.x, v.y, v.z);
}

Eigen::Vector3d in_double(real3 v) { return {v.x, v.y, v.z}; }

Eigen::Matrix3d matrix_of(body_motion e) {
    Eigen::Matrix3d m;
    m << e.shift.x, e.turn.z, e.turn.y, e.turn.z, e.shift.y, e.turn.x, e.turn.y, e.turn.x,
        e.shift.z;
    return m;
}

double product(body_motion a, body_motion b) {
    return in_double(a.shift).dot(in_double(b.shift)) + in_double(a.turn).dot(in_double(b.turn));
}

body_motion random_strain(Random& random, float size) {
    return make_motion(vector(random, size), vector(random, size));
}

TEST(BodyStrains, LeadToWhereTheirMatrixDoes) {
    Random random(1);
    for (int round = 0; round < 20; ++round) {
        const body_motion e = random_strain(random, 0.1f);
        const real3 r = vector(random, 0.3f);
        const Eigen::Vector3d expected = matrix_of(e) * in_double(r);
        EXPECT_LT((in_double(way_of_strain(e, r)) - expected).norm(), 1e-7);
        const real3 in_parts =
            add(multiply_mat(stretch_mat(r), e.shift), multiply_mat(shear_mat(r), e.turn));
        EXPECT_LT((in_double(in_parts) - expected).norm(), 1e-7);
        const real3 u = vector(random, 1.0f);
        EXPECT_NEAR(product(strain_part(outer_mat(r, u)), e), expected.dot(in_double(u)), 1e-7);
    }
}

TEST(BodyStrains, FormsAreThoseOfTheWays) {
    Random random(2);
    for (int round = 0; round < 20; ++round) {
        const body_motion e = random_strain(random, 1.0f);
        const real3 r = vector(random, 1.0f);
        const Eigen::Vector3d way = matrix_of(e) * in_double(r);
        const real3 normal = vector(random, 1.0f);
        const sym6 contact = form_of_arms(outer_sym(normal, 2.0f), stretch_mat(r), shear_mat(r));
        const double along = way.dot(in_double(normal));
        EXPECT_NEAR(product(e, multiply_sym6(contact, e)), 2.0 * along * along, 1e-5);
        const sym6 inertia = strain_inertia(outer_sym(r, 1.0f));
        EXPECT_NEAR(product(e, multiply_sym6(inertia, e)), way.squaredNorm(), 1e-5);
    }
}

/// The second differences of the energy that a solid has.
TEST(BodyStrains, StiffnessIsThatOfTetrahedraAtRest) {
    Random random(3);
    const double mu = 3.0, lambda = 7.0;
    const auto energy = [&](const Eigen::Matrix3d& map) {
        const double jacobian = map.determinant() - 1.0;
        return 0.5 * mu * (map.squaredNorm() - 3.0) - mu * jacobian +
               0.5 * lambda * jacobian * jacobian;
    };
    for (int round = 0; round < 20; ++round) {
        const body_motion e = random_strain(random, 1.0f);
        const Eigen::Matrix3d step = 1e-4 * matrix_of(e);
        const Eigen::Matrix3d rest = Eigen::Matrix3d::Identity();
        const double curvature = (energy(rest + step) + energy(rest - step)) / 1e-8;
        const sym6 form = strain_stiffness(3.0f, 4.0f);
        EXPECT_NEAR(product(e, multiply_sym6(form, e)), curvature, 1e-4 * curvature);
    }
}

TEST(BodyStrains, AreBounded) {
    const body_motion e = bounded_strain(make_motion(make3(3.0f, 0.0f, 0.0f), make3(0, 4.0f, 0)));
    EXPECT_FLOAT_EQ(e.shift.x, 0.06f);
    EXPECT_FLOAT_EQ(e.turn.y, 0.08f);
}

}  // namespace
}  // namespace weft::test
