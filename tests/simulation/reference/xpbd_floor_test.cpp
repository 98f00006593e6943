// Why XPBD does not end at the minimum of E: an experiment in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "simulation/families/convert.h"
#include "simulation/families/springs/springs.h"
#include "simulation/reference/newton.h"
#include "tests/simulation/reference/problems.h"

namespace weft::test {
namespace {

/// XPBD over springs in double precision, one after the other.
class DoubleXpbd {
public:
    DoubleXpbd(const Model& model, const IncrementalPotential& potential)
        : springs_(*model.find<Springs>()),
          predicted_(potential.predicted()),
          x_(predicted_),
          forces_(x_.size()),
          multipliers_(static_cast<std::size_t>(springs_.elements().count())) {
        for (const double inertia : potential.inertia()) {
            inverse_inertia_.push_back(inertia > 0.0 ? 1.0 / inertia : 0.0);
        }
    }

    /// Macklin et al. 2016 solve, for each constraint, M dx - grad C dl = -g and grad C dx + a dl =
    /// -(C + a l), and leave out g = M (x - x~) - sum of grad C l, which is 0 only as long as the
    /// constraints' gradients have not turned since their multipliers were made (section 4, below
    /// equation 10).
    void sweep(bool with_gradient) {
        for (int s = 0; s < springs_.elements().count(); ++s) project(s, with_gradient);
    }
    const std::vector<Vec3>& x() const { return x_; }

private:
    // In units of force: multipliers [N], compliances 1/k [m/N], inverse inertia h^2/m [m/N].
    void project(int s, bool with_gradient) {
        const auto ends = springs_.elements().vertices_of(s);
        const auto a = static_cast<std::size_t>(ends[0]);
        const auto b = static_cast<std::size_t>(ends[1]);
        double& multiplier = multipliers_[static_cast<std::size_t>(s)];
        const double wa = inverse_inertia_[a];
        const double wb = inverse_inertia_[b];
        const Vec3 along = x_[a] - x_[b];
        const Vec3 n = (1.0 / length(along)) * along;
        Vec3 ga, gb;
        if (with_gradient) {
            update_forces();
            ga = x_[a] - predicted_[a] - wa * forces_[a];
            gb = x_[b] - predicted_[b] - wb * forces_[b];
            if (wa == 0.0) ga = {};
            if (wb == 0.0) gb = {};
        }
        const double compliance = 1.0 / springs_.stiffness(s);
        const double error = length(along) - springs_.rest_length(s);
        const double change =
            (-error - compliance * multiplier + dot(n, ga - gb)) / (wa + wb + compliance);
        multiplier += change;
        x_[a] = x_[a] + wa * change * n - ga;
        x_[b] = x_[b] - wb * change * n - gb;
    }

    /// sum of grad C l, with the gradients where x is now.
    void update_forces() {
        std::fill(forces_.begin(), forces_.end(), Vec3{});
        for (int s = 0; s < springs_.elements().count(); ++s) {
            const auto ends = springs_.elements().vertices_of(s);
            const auto a = static_cast<std::size_t>(ends[0]);
            const auto b = static_cast<std::size_t>(ends[1]);
            const Vec3 along = x_[a] - x_[b];
            const Vec3 force = (multipliers_[static_cast<std::size_t>(s)] / length(along)) * along;
            forces_[a] = forces_[a] + force;
            forces_[b] = forces_[b] - force;
        }
    }

    const Springs& springs_;
    std::vector<Vec3> predicted_, x_, forces_;
    std::vector<double> inverse_inertia_, multipliers_;
};

/// One step of a sheet that is thrown, in double precision.
struct Thrown {
    Thrown(double stiffness, double step) : model(scene(stiffness, step), warnings) {
        for (std::size_t v = 0; v < model.positions->count(); ++v) {
            const Vec3 x = to_vec3((*model.positions)[v]);
            (*model.velocities)[v] = to_float4({0.0, 2.0 * x.x - 3.0 * x.z * x.z, 0.0});
        }
        potential = std::make_unique<IncrementalPotential>(model, 0.0);
        minimum = minimise(*potential, potential->predicted());
    }

    static Scene scene(double stiffness, double step) {
        Scene scene = parse_scene(kPinnedSheet, "test.toml");
        scene.dt = step * scene.substeps;
        scene.cloths[0].bend.reset();
        scene.cloths[0].stretch.stiffness = stiffness;
        return scene;
    }

    /// (E - E*) / (E0 - E*) after so many sweeps.
    double error_after(int sweeps, bool with_gradient) const {
        DoubleXpbd xpbd(model, *potential);
        for (int i = 0; i < sweeps; ++i) xpbd.sweep(with_gradient);
        return (potential->energy(xpbd.x()) - minimum.energy) /
               (minimum.start_energy - minimum.energy);
    }

    Warnings warnings;
    Model model;
    std::unique_ptr<IncrementalPotential> potential;
    Minimum minimum;
};

TEST(XpbdFloor, IsThereInDoublePrecision) {
    const Thrown thrown(1e3, 0.005);
    const double floor = thrown.error_after(500, false);
    EXPECT_GT(floor, 1e-5);
    EXPECT_NEAR(thrown.error_after(1000, false), floor, 1e-6 * floor);
}

TEST(XpbdFloor, IsGoneWithTheGradientThatXpbdLeavesOut) {
    for (const auto& [stiffness, step] : {std::pair(1e2, 0.01), std::pair(1e3, 0.005)}) {
        const Thrown thrown(stiffness, step);
        EXPECT_LT(std::abs(thrown.error_after(500, true)), 1e-12) << stiffness << ' ' << step;
    }
}

TEST(XpbdFloor, FallsFasterThanTheSquareOfTheStep) {
    double before = Thrown(1e3, 0.02).error_after(1000, false);
    for (const double step : {0.01, 0.005, 0.0025}) {
        const double floor = Thrown(1e3, step).error_after(1000, false);
        EXPECT_LT(floor, before / 4.0) << step;
        before = floor;
    }
}

}  // namespace
}  // namespace weft::test
