#include "kernels/matrix.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/kernels/random.h"

namespace weft::test {
namespace {

using namespace kernels;

real3 random_vector(Random& random) {
    return make3(random.real(-1.0f, 1.0f), random.real(-1.0f, 1.0f), random.real(-1.0f, 1.0f));
}

/// The sum of three random dyads and a little of I: positive definite.
sym3 random_matrix(Random& random) {
    sym3 a = diagonal_sym(0.05f);
    for (int k = 0; k < 3; ++k) a = add_sym(a, outer_sym(random_vector(random), 1.0f));
    return a;
}

TEST(SymmetricMatrix, SolutionsSatisfyTheirEquationsAtEveryScale) {
    Random random(5);
    for (int round = 0; round < 200; ++round) {
        const sym3 a = random_matrix(random);
        const real3 x = random_vector(random);
        for (const float unit : {1e-20f, 1e-8f, 1.0f, 1e12f}) {
            const real3 found = solve_sym(scale_sym(a, unit), scale(multiply_sym(a, x), unit));
            EXPECT_LT(length3(subtract(found, x)), 1e-4f * length3(x)) << "unit " << unit;
        }
    }
}

TEST(SymmetricMatrix, PowersOfTwoAsUnitsChangeNoBit) {
    Random random(6);
    const sym3 a = random_matrix(random);
    const real3 b = random_vector(random);
    const real3 large = solve_sym(scale_sym(a, 0x1p30f), scale(b, 0x1p30f));
    const real3 small = solve_sym(scale_sym(a, 0x1p-30f), scale(b, 0x1p-30f));
    EXPECT_EQ(large.x, small.x);
    EXPECT_EQ(large.y, small.y);
    EXPECT_EQ(large.z, small.z);
}

TEST(SymmetricMatrix, SingularOnesGiveAFiniteDescentDirection) {
    Random random(7);
    for (int round = 0; round < 200; ++round) {
        const real3 d = random_vector(random);
        const real3 b = random_vector(random);
        const real3 along = solve_sym(outer_sym(d, 1e4f), b);
        EXPECT_TRUE(std::isfinite(length3(along)));
        EXPECT_GE(dot3(along, b), 0.0f);
    }
    const real3 nothing = solve_sym(diagonal_sym(0.0f), make3(0.0f, 0.0f, 0.0f));
    EXPECT_EQ(length3(nothing), 0.0f);
}

TEST(SymmetricMatrix, ProductsAgreeWithTheirDefinition) {
    const real3 v = make3(1.0f, -2.0f, 3.0f);
    const real3 w = make3(4.0f, 5.0f, -1.0f);
    const real3 product = multiply_sym(add_diagonal(outer_sym(v, 2.0f), 7.0f), w);
    // 2 v (v . w) + 7 w with v . w = -9
    EXPECT_EQ(product.x, -18.0f + 28.0f);
    EXPECT_EQ(product.y, 36.0f + 35.0f);
    EXPECT_EQ(product.z, -54.0f - 7.0f);
    EXPECT_EQ(trace_sym(make_sym(1.0f, 9.0f, 9.0f, 2.0f, 9.0f, 4.0f)), 7.0f);
}

}  // namespace
}  // namespace weft::test
