// The small systems of stencils against dense ones.

#include "kernels/sosd/stencil.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "tests/kernels/random.h"

namespace weft::test {
namespace {

using namespace kernels;
using Eigen::MatrixXd;
using Eigen::VectorXd;

real3 random_vector(Random& random) {
    return make3(random.real(-1.0f, 1.0f), random.real(-1.0f, 1.0f), random.real(-1.0f, 1.0f));
}

/// An element's d2E = s G (x) I + c c^T, among others that add `around` times random matrices to
/// the corners' own blocks.
stencil random_stencil(Random& random, int corners, float around, float unit) {
    stencil s{};
    real3 shape[4], growth[4];
    for (int k = 0; k < corners; ++k) {
        shape[k] = random_vector(random);
        growth[k] = random_vector(random);
        vertex_system& corner = s.corner[k];
        corner.free = 1.0f;
        corner.force = scale(random_vector(random), unit);
        corner.stiffness =
            add_diagonal(outer_sym(growth[k], 1.0f), dot3(shape[k], shape[k]) + 0.01f * around);
        for (int n = 0; n < 3; ++n) {
            corner.stiffness = add_sym(corner.stiffness, outer_sym(random_vector(random), around));
        }
        corner.stiffness = scale_sym(corner.stiffness, unit);
        for (int j = 0; j < k; ++j) {
            mat3& block = s.coupling[k * (k - 1) / 2 + j];
            block = outer_mat(scale(growth[j], unit), growth[k]);
            block = add_diagonal_mat(block, unit * dot3(shape[j], shape[k]));
        }
    }
    return s;
}

Eigen::Vector3d to_eigen(real3 v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// The system, of corners that are free.
struct Dense {
    MatrixXd stiffness;
    VectorXd force;

    Dense(const stencil& s, int corners)
        : stiffness(MatrixXd::Zero(3 * corners, 3 * corners)), force(3 * corners) {
        for (int k = 0; k < corners; ++k) {
            const sym3& d = s.corner[k].stiffness;
            stiffness.block<3, 3>(3 * k, 3 * k) << d.xx, d.xy, d.xz, d.xy, d.yy, d.yz, d.xz, d.yz,
                d.zz;
            force.segment<3>(3 * k) = to_eigen(s.corner[k].force);
            for (int j = 0; j < k; ++j) {
                const mat3& b = s.coupling[k * (k - 1) / 2 + j];
                Eigen::Matrix3d block;
                block << to_eigen(b.x), to_eigen(b.y), to_eigen(b.z);
                stiffness.block<3, 3>(3 * j, 3 * k) = block;
                stiffness.block<3, 3>(3 * k, 3 * j) = block.transpose();
            }
        }
        for (int k = 0; k < corners; ++k) {
            if (s.corner[k].free > 0.0f) continue;
            stiffness.middleRows(3 * k, 3).setZero();
            stiffness.middleCols(3 * k, 3).setZero();
            stiffness.block<3, 3>(3 * k, 3 * k).setIdentity();
            force.segment<3>(3 * k).setZero();
        }
    }
    double model(const VectorXd& x) const { return 0.5 * x.dot(stiffness * x) - force.dot(x); }
    double least() const { return model(stiffness.ldlt().solve(force)); }
};

VectorXd solved(const stencil& s, int corners) {
    const stencil_vector step = solve_stencil(s, corners);
    VectorXd x(3 * corners);
    for (int k = 0; k < corners; ++k) {
        x.segment<3>(3 * k) = to_eigen(scale(step.at[k], s.corner[k].free));
    }
    return x;
}

class Stencil : public testing::TestWithParam<int> {};

TEST_P(Stencil, AmongOthersIsNearlySolved) {
    Random random(1);
    for (int round = 0; round < 200; ++round) {
        // As in a mesh, where an element is one of many at its corners.
        const stencil s = random_stencil(random, GetParam(), 8.0f, 1.0f);
        const Dense dense(s, GetParam());
        const double least = dense.least();
        ASSERT_LT(least, 0.0);
        EXPECT_LT(dense.model(solved(s, GetParam())), 0.9 * least);
    }
}

TEST_P(Stencil, AloneNeverRaisesTheModelAndIsFinite) {
    Random random(2);
    for (int round = 0; round < 200; ++round) {
        for (const float around : {1.0f, 1e-3f, 1e-8f, 0.0f}) {
            const stencil s = random_stencil(random, GetParam(), around, 1.0f);
            const VectorXd x = solved(s, GetParam());
            ASSERT_TRUE(x.allFinite());
            EXPECT_LT(Dense(s, GetParam()).model(x), 0.0) << around;
        }
    }
}

TEST_P(Stencil, HeldCornersStandStillAndOthersKnowIt) {
    Random random(3);
    for (int round = 0; round < 200; ++round) {
        stencil s = random_stencil(random, GetParam(), 8.0f, 1.0f);
        for (int k = 0; k < GetParam(); k += 2) s.corner[k].free = 0.0f;
        const Dense dense(s, GetParam());
        const stencil_vector step = solve_stencil(s, GetParam());
        for (int k = 0; k < GetParam(); k += 2) EXPECT_EQ(length3(step.at[k]), 0.0f);
        EXPECT_LT(dense.model(solved(s, GetParam())), 0.9 * dense.least());
    }
}

TEST_P(Stencil, UnitsChangeNoBit) {
    for (const float unit : {0x1p-40f, 0x1p30f}) {
        Random random(4), again(4);
        for (int round = 0; round < 50; ++round) {
            const stencil s = random_stencil(random, GetParam(), 2.0f, 1.0f);
            const stencil scaled = random_stencil(again, GetParam(), 2.0f, unit);
            EXPECT_EQ(solved(s, GetParam()), solved(scaled, GetParam()));
        }
    }
}

TEST_P(Stencil, AtItsMinimumStaysThere) {
    Random random(5);
    stencil s = random_stencil(random, GetParam(), 1.0f, 1.0f);
    for (int k = 0; k < GetParam(); ++k) s.corner[k].force = make3(0.0f, 0.0f, 0.0f);
    EXPECT_EQ(solved(s, GetParam()).norm(), 0.0);
    stencil nothing{};
    for (int k = 0; k < GetParam(); ++k) nothing.corner[k].free = 1.0f;
    EXPECT_EQ(solved(nothing, GetParam()).norm(), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Corners, Stencil, testing::Values(3, 4));

}  // namespace
}  // namespace weft::test
