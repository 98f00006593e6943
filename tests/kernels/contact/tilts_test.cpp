#include "kernels/contact/tilts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "simulation/mesh/vec3.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

constexpr int kSide = 5;
constexpr int kVertices = kSide * kSide;
constexpr int kFaces = 2 * (kSide - 1) * (kSide - 1);
constexpr double kEdge = 0.01;                       // [m]
constexpr double kQuiet = 0.4 * 0.70710678 * kEdge;  // as SurfaceBuffers has it
constexpr std::array<int, 6> kSquare{0, 1, kSide, 1, kSide + 1, kSide};

std::size_t at(int i) { return static_cast<std::size_t>(i); }
Vec3 vec(const float4& v) { return {v.x, v.y, v.z}; }

/// A patch that is a sheet of 4 x 4 squares, and bends, drifts and trembles.
class BendingPatch {
public:
    BendingPatch() {
        for (int f = 0; f < kFaces; ++f) {
            const int square = f / 2;
            const int low = square / (kSide - 1) * kSide + square % (kSide - 1);
            for (int k = 0; k < 3; ++k) {
                corners_[at(f + k * kFaces)] = low + kSquare[at(3 * (f % 2) + k)];
            }
        }
        begin_[1] = 1;
        faces_[1] = kFaces;
        rim_begin_[1] = kVertices;
        for (int v = 0; v < kVertices; ++v) rims_[at(v)] = v;
        quiet_[0] = static_cast<float>(kQuiet);
    }

    /// bend   the angle between its ends [rad]
    /// reach  how far its vertices may get [m]
    void move_to(double bend, Vec3 drift, double tremble, double reach, Random& random) {
        for (int v = 0; v < kVertices; ++v) {
            const double along = kEdge * (v / kSide - 0.5 * (kSide - 1));
            const double curvature = bend / (kEdge * (kSide - 1));
            const double angle = curvature * along;
            const Vec3 bent = bend == 0.0 ? Vec3{along, 0.0, 0.0}
                                          : Vec3{std::sin(angle) / curvature,
                                                 (1.0 - std::cos(angle)) / curvature, 0.0};
            const Vec3 shake = vec(random.point(static_cast<float>(tremble)));
            const Vec3 x = bent + Vec3{0.0, 0.0, kEdge * (v % kSide)} + drift + shake;
            const float4 to{static_cast<float>(x.x), static_cast<float>(x.y),
                            static_cast<float>(x.z),
                            static_cast<float>(reach) * random.real(0.8f, 1.0f)};
            float4& from = anchors_[at(v)];
            strides_[at(v)] = {to.x - from.x, to.y - from.y, to.z - from.z, to.w - from.w};
            from = goals_[at(v)] = to;
        }
    }

    /// Whether it is flat and quiet by itself.
    bool is_flat(int instance) {
        const Segments one{&begin_, 0, 1, 1};
        const TaskBody body{"tilt",
                            0,
                            {launch(kernels::tilt_patches, one, anchors_, goals_, strides_,
                                    foresees_, faces_, corners_, rim_begin_, rims_, high_, quiet_,
                                    worn_, tilts_, drifts_, kFaces, kInstance)}};
        run_on_host(body, 0, instance);
        return tilts_[0].w == 1.0f;
    }

    /// How far it faces as it says, at least, wherever its vertices get: the least cosine.
    double least_facing(Random& random) const {
        std::vector<Vec3> x;
        for (int v = 0; v < kVertices; ++v) {
            const float4& anchor = anchors_[at(v)];
            const Vec3 way = vec(random.point(1.0f));
            x.push_back(vec(anchor) + (double{anchor.w} / length(way)) * way);
        }
        double least = 1.0;
        for (int f = 0; f < kFaces; ++f) {
            const auto corner = [&](int k) { return x[at(corners_[at(f + k * kFaces)])]; };
            const Vec3 normal = cross(corner(1) - corner(0), corner(2) - corner(0));
            least = std::min(least, dot(normal, vec(tilts_[0])) / length(normal));
        }
        return least;
    }

    float4 tilt() const { return tilts_[0]; }

private:
    Buffer<int> begin_{"begin", 2}, faces_{"faces", 2}, corners_{"corners", 3 * kFaces};
    Buffer<int> rim_begin_{"rim_begin", 2}, rims_{"rims", kVertices}, foresees_{"foresees", 1};
    Buffer<float4> anchors_{"anchors", kVertices}, goals_{"goals", kVertices};
    Buffer<float4> strides_{"strides", kVertices}, high_{"high", 1};
    Buffer<float> quiet_{"quiet", 1}, worn_{"worn", 1};
    Buffer<float4> tilts_{"tilts", 1}, drifts_{"drifts", 1};
};

struct Bending {
    double per_substep;  ///< [rad]
    double tremble;      ///< [m]
    double reach;        ///< [m]
};

/// No triangle turns over in a patch that is passed over, be it looked at in this substep or in an
/// earlier one; and most substeps look at nothing.
TEST(Tilts, WhatIsFlatCannotFoldWhileNobodyLooks) {
    Random random(3);
    int flat = 0, kept = 0, ended = 0;
    for (const Bending& bending : {Bending{0.03, 1e-5, 0.2 * kQuiet},
                                   {0.002, 1e-6, 0.5 * kQuiet},
                                   {0.1, 1e-4, 0.1 * kQuiet},
                                   {0.0, 2e-4, 0.3 * kQuiet}}) {
        BendingPatch patch;
        for (int substep = 0; substep < 120; ++substep) {
            patch.move_to(bending.per_substep * substep, {0.05 * substep, -0.02 * substep, 0.0},
                          bending.tremble, bending.reach, random);
            const float4 before = patch.tilt();
            if (!patch.is_flat(substep)) {
                ++ended;
                continue;
            }
            ++flat;
            kept += before.x == patch.tilt().x && before.y == patch.tilt().y ? 1 : 0;
            for (int trial = 0; trial < 50; ++trial) {
                ASSERT_GT(patch.least_facing(random), 0.0)
                    << "substep " << substep << ", " << bending.per_substep << " rad";
            }
        }
    }
    EXPECT_GT(flat, 150);
    EXPECT_GT(kept, flat / 2);
    EXPECT_GT(ended, 50);
}

/// What was kept in another frame does not count.
TEST(Tilts, AreLookedAtWhereAFrameBegins) {
    Random random(4);
    BendingPatch patch;
    patch.move_to(0.0, {}, 0.0, 0.1 * kQuiet, random);
    EXPECT_TRUE(patch.is_flat(0));
    patch.move_to(3.0, {}, 0.0, 0.1 * kQuiet, random);
    EXPECT_FALSE(patch.is_flat(0));
    patch.move_to(0.0, {}, 0.0, 0.1 * kQuiet, random);
    EXPECT_TRUE(patch.is_flat(1));
    patch.move_to(3.0, {}, 0.0, 0.1 * kQuiet, random);
    EXPECT_FALSE(patch.is_flat(2)) << "it has bent by far more than may be used up";
}

}  // namespace
}  // namespace weft::test
