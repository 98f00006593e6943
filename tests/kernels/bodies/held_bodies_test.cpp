// How bodies move that are held in some vertices, against double precision.

#include "kernels/bodies/held_bodies.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "tests/kernels/random.h"
#include "tests/kernels/run_on_host.h"

namespace weft::test {
namespace {

using namespace kernels;

Eigen::Vector3d in_double(real3 v) { return {v.x, v.y, v.z}; }
real3 in_single(const Eigen::Vector3d& v) {
    return make3(static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()));
}

/// A body of equal masses, seen from where it is held first, that springs hold there and elsewhere.
struct Hung {
    std::vector<Eigen::Vector3d> places, lags;  ///< r, x~ - x
    std::vector<Eigen::Vector3d> held, pulls;   ///< r, g
    std::vector<Eigen::Matrix3d> blocks;        ///< in units of inertia

    explicit Hung(std::uint32_t seed, double stiffness) {
        Random random(seed);
        const auto point = [&](float size) {
            const float4 p = random.point(size);
            return Eigen::Vector3d(p.x, p.y, p.z);
        };
        for (int v = 0; v < 20; ++v) {
            places.push_back(point(0.5f));
            lags.push_back(point(0.002f));
        }
        for (const Eigen::Vector3d& r :
             {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.7, 0.1, -0.2)}) {
            held.push_back(r);
            pulls.push_back(stiffness * point(0.001f));
            const Eigen::Vector3d line = point(1.0f).normalized();
            blocks.emplace_back(stiffness *
                                (line * line.transpose() + 0.1 * Eigen::Matrix3d::Identity()));
        }
    }

    moments seen() const {
        moments m = no_moments();
        for (std::size_t v = 0; v < places.size(); ++v) {
            moments one = no_moments();
            const real3 r = in_single(places[v]);
            one.spread = outer_sym(r, 1.0f);
            one.offset = r;
            one.lag = in_single(lags[v]);
            one.lags = outer_mat(r, one.lag);
            m = add_share_of_moments(m, one, 1.0f / static_cast<float>(places.size()));
        }
        return m;
    }

    hold hold_of() const {
        hold all = no_hold();
        for (std::size_t p = 0; p < held.size(); ++p) {
            const real3 r = in_single(held[p]);
            const real3 g = in_single(pulls[p]);
            const Eigen::Matrix3f b = blocks[p].cast<float>();
            const sym3 block = make_sym(b(0, 0), b(0, 1), b(0, 2), b(1, 1), b(1, 2), b(2, 2));
            all.pull = add_scaled_motion(all.pull, make_motion(g, cross3(r, g)), 1.0f);
            all.form = add_scaled_sym6(all.form, form_at_lever(block, r), 1.0f);
        }
        return all;
    }

    /// E of a motion: inertia of the rotation by its turn, and elements of the way that it starts.
    double energy(const Eigen::Vector3d& shift, const Eigen::Vector3d& turn) const {
        const double size = turn.norm();
        Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
        if (size > 0.0)
            rotation =
                Eigen::AngleAxisd(2.0 * std::atan(0.5 * size), turn / size).toRotationMatrix();
        double sum = 0.0;
        for (std::size_t v = 0; v < places.size(); ++v) {
            const Eigen::Vector3d way = shift + rotation * places[v] - places[v];
            sum += 0.5 * (way - lags[v]).squaredNorm() / static_cast<double>(places.size());
        }
        for (std::size_t p = 0; p < held.size(); ++p) {
            const Eigen::Vector3d way = shift + turn.cross(held[p]);
            sum += 0.5 * way.dot(blocks[p] * way) - pulls[p].dot(way);
        }
        return sum;
    }
};

TEST(HeldBodies, MoveToTheMinimum) {
    for (const double stiffness : {0.0, 3.0, 300.0}) {
        for (std::uint32_t seed = 1; seed < 6; ++seed) {
            const Hung body(seed, stiffness);
            const body_motion found = missing_beside(body.seen(), body.hold_of());
            const Eigen::Vector3d shift = in_double(found.shift), turn = in_double(found.turn);
            const double least = body.energy(shift, turn);
            const Eigen::Vector3d none = Eigen::Vector3d::Zero();
            EXPECT_LT(least, body.energy(none, none));
            for (int k = 0; k < 3; ++k) {
                for (const double off : {-1e-4, 1e-4}) {
                    const Eigen::Vector3d way = off * Eigen::Vector3d::Unit(k);
                    EXPECT_LT(least, body.energy(shift + way, turn)) << stiffness << ' ' << seed;
                    EXPECT_LT(least, body.energy(shift, turn + 3.0 * way))
                        << stiffness << ' ' << seed;
                }
            }
        }
    }
}

/// What a body lacks about a line, whatever holds it there.
TEST(HeldBodies, SwingAboutALine) {
    const Hung body(3, 0.0);
    const Eigen::Vector3d axis = Eigen::Vector3d(0.7, 0.1, -0.2).normalized();
    const Eigen::Vector3d turn = in_double(missing_swing(body.seen(), in_single(axis)));
    EXPECT_LT(turn.cross(axis).norm(), 1e-6 * turn.norm());
    const Eigen::Vector3d none = Eigen::Vector3d::Zero();
    const double least = body.energy(none, turn);
    EXPECT_LT(least, body.energy(none, none));
    for (const double off : {-1e-4, 1e-4}) EXPECT_LT(least, body.energy(none, turn + off * axis));
}

TEST(HeldBodies, SwingAboutAPoint) {
    const Hung body(4, 0.0);
    const Eigen::Vector3d none = Eigen::Vector3d::Zero();
    const Eigen::Vector3d turn = in_double(missing_swing(body.seen(), make3(0.0f, 0.0f, 0.0f)));
    const double least = body.energy(none, turn);
    for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d way = 1e-4 * Eigen::Vector3d::Unit(k);
        EXPECT_LT(least, body.energy(none, turn + way));
        EXPECT_LT(least, body.energy(none, turn - way));
    }
}

}  // namespace
}  // namespace weft::test
