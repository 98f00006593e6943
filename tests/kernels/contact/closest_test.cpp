// Closest points against a search for the least distance, in double precision. Compiled twice: in
// single precision, as kernels use it, and in double.

#include "kernels/contact/closest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "tests/kernels/random.h"

namespace weft::test {
namespace {

using kernels::closest_points;
using kernels::real;
using kernels::real3;
using Corners = std::array<real3, 4>;
using Weights = std::array<double, 4>;

constexpr double kRounding = sizeof(real) == sizeof(float) ? 3e-6 : 1e-11;

struct Distance {
    std::array<double, 3> way;
    double square;
};

/// As seen from the last corner: weights add up to 0, but for rounding.
Distance combine(const Corners& x, const Weights& w) {
    Distance d{};
    for (std::size_t j = 0; j < 3; ++j) {
        const real3 from_last = kernels::subtract(x[j], x[3]);
        d.way[0] += w[j] * static_cast<double>(from_last.x);
        d.way[1] += w[j] * static_cast<double>(from_last.y);
        d.way[2] += w[j] * static_cast<double>(from_last.z);
    }
    d.square = d.way[0] * d.way[0] + d.way[1] * d.way[1] + d.way[2] * d.way[2];
    return d;
}

/// The least value of a convex function on [0, 1].
double least(const std::function<double(double)>& value) {
    double low = 0.0;
    double high = 1.0;
    for (int step = 0; step < 80; ++step) {
        const double a = low + (high - low) / 3.0;
        const double b = high - (high - low) / 3.0;
        (value(a) <= value(b) ? high : low) = value(a) <= value(b) ? b : a;
    }
    return std::min({value(low), value(0.0), value(1.0)});
}

double searched_distance(const Corners& x, const std::function<Weights(double, double)>& weights) {
    return std::sqrt(least([&](double s) {
        return least([&](double t) { return combine(x, weights(s, t)).square; });
    }));
}

Weights of_triangle(double s, double t) { return {1.0, -(1.0 - s), -s * (1.0 - t), -s * t}; }
Weights of_edges(double s, double t) { return {1.0 - s, s, -(1.0 - t), -t}; }

closest_points vertex_triangle(const Corners& x) {
    return kernels::closest_vertex_triangle(x[0], x[1], x[2], x[3]);
}
closest_points edges(const Corners& x) { return kernels::closest_edges(x[0], x[1], x[2], x[3]); }

Weights weights_of(const closest_points& c) {
    return {c.weights.x, c.weights.y, c.weights.z, c.weights.w};
}

/// What is said of the closest points agrees with itself and with the search.
void expect_closest(const closest_points& c, const Corners& x, double searched, double size) {
    const Weights w = weights_of(c);
    EXPECT_NEAR(w[0] + w[1] + w[2] + w[3], 0.0, kRounding);
    for (const double weight : w) EXPECT_LE(std::abs(weight), 1.0 + kRounding);
    const Distance d = combine(x, w);
    EXPECT_NEAR(d.way[0], static_cast<double>(c.way.x), kRounding * size);
    EXPECT_NEAR(d.way[1], static_cast<double>(c.way.y), kRounding * size);
    EXPECT_NEAR(d.way[2], static_cast<double>(c.way.z), kRounding * size);
    EXPECT_NEAR(std::sqrt(static_cast<double>(c.square)), searched, 2.0 * kRounding * size);
}

void expect_closest(const Corners& x, double size) {
    expect_closest(vertex_triangle(x), x, searched_distance(x, of_triangle), size);
    expect_closest(edges(x), x, searched_distance(x, of_edges), size);
}

real3 random_point(Random& random, float size) {
    const float4 p = random.point(size);
    return {p.x, p.y, p.z};
}

TEST(Closest, AgreesWithASearchOnRandomPrimitives) {
    Random random(1);
    for (int n = 0; n < 60; ++n) {
        Corners x;
        for (real3& corner : x) corner = random_point(random, 1.0f);
        expect_closest(x, 2.0);
    }
}

/// Coordinates of a few values only: parallel, touching, collapsed, in one plane.
TEST(Closest, AgreesWithASearchOnDegenerateOnes) {
    Random random(2);
    for (int n = 0; n < 200; ++n) {
        Corners x;
        for (real3& corner : x) {
            corner = {static_cast<real>(random.integer(0, 2)),
                      static_cast<real>(random.integer(0, 1)),
                      static_cast<real>(random.integer(0, n % 2))};
        }
        expect_closest(x, 2.0);
    }
}

/// Small ones far from the origin: coordinates are rounded, but the ways between them are exact.
TEST(Closest, IsAsGoodFarFromTheOrigin) {
    Random random(3);
    for (int n = 0; n < 40; ++n) {
        Corners x;
        for (real3& corner : x) {
            corner = random_point(random, 0.01f);
            corner = {corner.x + real{20}, corner.y - real{10}, corner.z + real{5}};
        }
        expect_closest(x, 0.02);
    }
}

/// Two nearly parallel edges that cross: the closest points are inside, not at an end.
TEST(Closest, SeesWhereNearlyParallelEdgesCross) {
    for (const real tilt : {real(1e-2), real(1e-3), real(3e-4)}) {
        const Corners x{real3{-1, 0, 0}, real3{1, 0, 0}, real3{-1, real(1e-4), -tilt},
                        real3{1, real(1e-4), tilt}};
        const closest_points c = edges(x);
        EXPECT_NEAR(std::sqrt(static_cast<double>(c.square)), 1e-4, 1e-7);
        EXPECT_NEAR(static_cast<double>(c.weights.y), 0.5, 0.01);
    }
}

TEST(Closest, WeightsOfZeroNameTheFeature) {
    const real3 a{0, 0, 0};
    const real3 b{1, 0, 0};
    const real3 c{0, 1, 0};
    const auto of = [&](real3 p) {
        return weights_of(kernels::closest_vertex_triangle(p, a, b, c));
    };
    EXPECT_EQ(of({real(0.25), real(0.25), 1}), (Weights{1, -0.5, -0.25, -0.25}));
    EXPECT_EQ(of({real(0.25), -1, 1}), (Weights{1, -0.75, -0.25, 0}));
    EXPECT_EQ(of({-1, real(0.25), 1}), (Weights{1, -0.75, 0, -0.25}));
    EXPECT_EQ(of({1, 1, 0}), (Weights{1, 0, -0.5, -0.5}));
    EXPECT_EQ(of({-1, -1, 0}), (Weights{1, -1, 0, 0}));
    EXPECT_EQ(of({3, -1, 0}), (Weights{1, 0, -1, 0}));
    EXPECT_EQ(of({-1, 3, 0}), (Weights{1, 0, 0, -1}));
    EXPECT_EQ(weights_of(edges({a, b, real3{2, 0, 1}, real3{2, 1, 1}})), (Weights{0, 1, -1, 0}));
}

}  // namespace
}  // namespace weft::test
