#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "kernels/descent/cloth_reactions.h"

namespace weft::test {
namespace {

Eigen::Vector3f vector(kernels::real3 v) { return {v.x, v.y, v.z}; }
kernels::real3 real3_of(const Eigen::Vector3f& v) { return kernels::make3(v.x(), v.y(), v.z()); }

/// A vertex on the ground, y up: held by its elements as A says, drawn by r.
struct OnGround {
    Eigen::Matrix3f A = Eigen::Matrix3f::Identity();
    Eigen::Vector3f r{0.0f, -1.0f, 0.0f}, slip{0.0f, 0.0f, 0.0f};
    float gap = 0.0f, friction = 0.5f;

    Eigen::Vector3f borne() const {
        const kernels::surface_contact contact{gap, 1.0f, friction, kernels::make3(0, 1, 0),
                                               real3_of(slip)};
        const kernels::sym3 stiffness =
            kernels::make_sym(A(0, 0), A(0, 1), A(0, 2), A(1, 1), A(1, 2), A(2, 2));
        return vector(kernels::borne_of_vertex(stiffness, real3_of(r), contact));
    }
    Eigen::Vector3f step() const { return A.inverse() * (r + borne()); }
    /// What is left of its slip.
    Eigen::Vector3f slip_left() const {
        const Eigen::Vector3f all = slip + step();
        return {all.x(), 0.0f, all.z()};
    }
};

Eigen::Vector3f along(const Eigen::Vector3f& v) { return {v.x(), 0.0f, v.z()}; }

/// Elements that hold a vertex a thousand times as hard as inertia change nothing of Coulomb's law.
TEST(ClothReactions, StickBelowTheAngleOfFrictionAndSlideBeyond) {
    for (const float stiffness : {1.0f, 1e3f}) {
        OnGround vertex;
        vertex.A *= stiffness;
        vertex.r.x() = 0.49f;
        EXPECT_NEAR((vertex.borne() - Eigen::Vector3f(-0.49f, 1.0f, 0.0f)).norm(), 0.0f, 1e-5f);
        vertex.r.x() = 0.8f;
        EXPECT_NEAR((vertex.borne() - Eigen::Vector3f(-0.5f, 1.0f, 0.0f)).norm(), 0.0f, 1e-5f);
    }
}

TEST(ClothReactions, TakeBackWhatHasSlippedAsFarAsFrictionCan) {
    OnGround vertex;
    vertex.slip = {0.3f, 0.0f, 0.0f};
    EXPECT_NEAR((vertex.step() - Eigen::Vector3f(-0.3f, 0.0f, 0.0f)).norm(), 0.0f, 1e-6f);
    vertex.slip = {0.0f, 0.0f, 2.0f};
    EXPECT_NEAR((vertex.step() - Eigen::Vector3f(0.0f, 0.0f, -0.5f)).norm(), 0.0f, 1e-6f);
}

TEST(ClothReactions, AreNoneOfWhatLeaves) {
    OnGround vertex;
    vertex.r.y() = 0.1f;
    EXPECT_EQ(vertex.borne(), Eigen::Vector3f(0.0f, 0.0f, 0.0f));
    vertex.r.y() = -0.1f;
    vertex.gap = 0.2f;
    EXPECT_EQ(vertex.borne(), Eigen::Vector3f(0.0f, 0.0f, 0.0f));
    vertex.gap = 0.05f;
    EXPECT_NEAR(vertex.step().y(), -0.05f, 1e-6f);
}

/// Cloth is stiff along its plane, and soft across.
TEST(ClothReactions, KeepTheLawsWhateverHoldsTheVertex) {
    std::mt19937 generator(7);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    const auto any = [&] {
        return Eigen::Vector3f(uniform(generator), uniform(generator), uniform(generator));
    };
    int sticking = 0;
    float dissipated = 0.0f, most = 0.0f;
    for (int trial = 0; trial < 1000; ++trial) {
        OnGround vertex;
        for (int k = 0; k < 2; ++k) {
            const Eigen::Vector3f edge = any().normalized();
            vertex.A += 4.0f * edge * edge.transpose();
        }
        vertex.r = 3.0f * any() - Eigen::Vector3f(0.0f, 2.0f, 0.0f);
        vertex.slip = 0.3f * along(any());
        vertex.friction = 0.3f;
        const Eigen::Vector3f borne = vertex.borne();
        const float rub = along(borne).norm();
        ASSERT_GE(borne.y(), 0.0f);
        EXPECT_GE(vertex.step().y(), -1e-5f);
        EXPECT_LE(rub, 0.3f * borne.y() + 1e-5f);
        if (borne.y() == 0.0f) continue;
        EXPECT_NEAR(vertex.step().y(), 0.0f, 1e-5f);
        const Eigen::Vector3f slip = vertex.slip_left();
        const bool sticks = rub < 0.299f * borne.y();
        sticking += sticks ? 1 : 0;
        if (sticks) {
            EXPECT_NEAR(slip.norm(), 0.0f, 1e-5f);
        }
        EXPECT_LE(along(borne).dot(slip), 1e-6f);
        dissipated -= along(borne).dot(slip);
        most += rub * slip.norm();
    }
    EXPECT_GT(sticking, 30);
    EXPECT_GT(dissipated, 0.97f * most);
}

/// Held so that friction would push it inwards.
TEST(ClothReactions, StayFiniteWhereFrictionJams) {
    OnGround vertex;
    const Eigen::Vector3f edge = Eigen::Vector3f(0.2f, 1.0f, 0.0f).normalized();
    vertex.A += 1e4f * edge * edge.transpose();
    vertex.friction = 8.0f;
    vertex.r = {30.0f, -3.0f, 0.0f};
    vertex.slip = {-10.0f, 0.0f, 0.0f};
    EXPECT_TRUE(vertex.borne().allFinite());
}

}  // namespace
}  // namespace weft::test
