// How the paper's variants of asynchronous iterations converge: its figures 4 and 7, with numbers.
// The results depend on nothing but the settings, so these are the same on every machine.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "runtime/tbb/cpu_device.h"
#include "simulation/reference/newton.h"
#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"

namespace weft::test {
namespace {

/// Hangs from two corners, in motion: stretching and bending disagree.
const std::string kHanging = R"(
[scene]
frames = 4
dt = 0.016
substeps = 4
[solver]
method = "xpbd"
iterations = 8

[[cloth]]
grid = { size = [0.6, 1.5], resolution = [12, 30] }
translate = [0.0, 1.0, 0.0]
density = 0.2
stretch = { stiffness = 1.0e3 }
bend = { stiffness = 5.0e-3 }
pins = { corners = ["x-z-", "x+z-"] }
)";

/// The same, above a ball that it has reached by then.
const std::string kBall = R"(
[[obstacle]]
shape = "sphere"
center = [0.0, 0.84, 0.0]
radius = 0.15
)";

/// One substep from a state in the middle of a run, by any plan.
class OneStep {
public:
    explicit OneStep(const std::string& text, int frames = 4) : scene_(parse_scene(text, "test")) {
        Simulation run(scene_, cpus(1), synchronous(), warnings_);
        while (run.frame() < frames) run.advance();
        positions_ = run.positions();
        velocities_ = run.velocities();
        substep_ = frames * scene_.substeps;
        scene_.dt /= scene_.substeps;
        scene_.substeps = 1;
    }

    /// xyz in scene order. settings: null: synchronous
    std::vector<float> after(int iterations, const char* settings) {
        Scene scene = scene_;
        scene.solver.iterations = iterations;
        SimulationOptions options = synchronous();
        if (settings != nullptr) {
            options.plan = PlanKind::kAsync;
            options.async = parse_async_settings(settings);
        }
        Simulation step(scene, cpus(settings == nullptr ? 1 : 2), options, warnings_);
        step.start_from(substep_, positions_, velocities_);
        step.advance({.tasks = false});
        return step.positions();
    }

    /// (E - E*) / (E0 - E*)
    double error(int iterations, const char* settings) {
        if (!potential_) solve();
        std::vector<Vec3> x(potential_->predicted().size());
        model_->from_scene_order(after(iterations, settings), x);
        return (potential_->energy(x) - minimum_.energy) /
               (minimum_.start_energy - minimum_.energy);
    }

    const Scene& scene() const { return scene_; }

private:
    static std::vector<std::unique_ptr<Device>> cpus(int count) {
        std::vector<std::unique_ptr<Device>> devices;
        for (int d = 0; d < count; ++d) devices.push_back(make_cpu_device(1, {}));
        return devices;
    }
    static SimulationOptions synchronous() {
        SimulationOptions options;
        options.plan = PlanKind::kSingle;
        options.calibrate = false;
        options.on_trouble = OnTrouble::kIgnore;
        return options;
    }
    void solve() {
        model_ = std::make_unique<Model>(scene_, warnings_);
        model_->from_scene_order(positions_, model_->positions->span());
        model_->from_scene_order(velocities_, model_->velocities->span());
        potential_ = std::make_unique<IncrementalPotential>(*model_, substep_ * scene_.dt);
        minimum_ = minimise(*potential_, potential_->predicted());
        EXPECT_LT(minimum_.certificate.relative_gap, kSolvedGap);
    }

    Scene scene_;
    Warnings warnings_;
    std::vector<float> positions_, velocities_;
    int substep_ = 0;
    std::unique_ptr<Model> model_;
    std::unique_ptr<IncrementalPotential> potential_;
    Minimum minimum_;
};

constexpr int kIterations = 60;

class Figures : public testing::Test {
protected:
    /// By tasks of a kind each, news taking a fifth of an iteration, as the paper's copies do.
    double by_kinds(const std::string& settings, int iterations = kIterations) {
        return step_.error(iterations, ("tasks=kinds,wait=0.2" + settings).c_str());
    }
    double serial() { return step_.error(kIterations, nullptr); }

    OneStep step_{kHanging};
};

/// The rank makes up for what is lost; the synchronous solver is not beaten.
/// Measured: serial 4.39e-2, with the rank 4.55e-2, without 6.10e-2.
TEST_F(Figures, FourA) {
    const double with_rank = by_kinds("");
    EXPECT_LT(with_rank, 1.1 * serial());
    EXPECT_GT(with_rank, serial());
    EXPECT_GT(by_kinds(",rank=off"), 1.2 * with_rank);
}

/// Overlap of both sorts is better than either alone.
/// Measured: both 4.55e-2, within 5.86e-2, across 6.63e-2.
TEST_F(Figures, FourBWithoutObstacles) {
    const double both = by_kinds("");
    EXPECT_GT(by_kinds(",order=within"), 1.1 * both);
    EXPECT_GT(by_kinds(",order=across"), 1.2 * both);
}

/// Displacements are better than positions, without dropping better than with it; and XPBD wants
/// motions in full, which with dropping comes to no end.
/// Measured: mean 1.071e-1, position 1.133e-1; with dropping 1.198e-1, 1.232e-1, motions in
/// full 7.8.
TEST_F(Figures, FourC) {
    const double mean = by_kinds(",merge=mean");
    const double mean_dropping = by_kinds(",merge=mean,dropping=on");
    EXPECT_LT(mean, by_kinds(",merge=position"));
    EXPECT_LT(mean_dropping, by_kinds(",merge=position,dropping=on"));
    EXPECT_LT(1.05 * mean, mean_dropping);
    EXPECT_LT(2.0 * by_kinds(""), mean);
    EXPECT_GT(by_kinds(",dropping=on"), 1.0);
}

double distance(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double apart = static_cast<double>(a[i]) - static_cast<double>(b[i]);
        sum += apart * apart;
    }
    return std::sqrt(sum / static_cast<double>(a.size()));
}

class WithABall : public testing::Test {
protected:
    std::vector<float> after(int iterations, const std::string& settings) {
        return step_.after(iterations, ("tasks=kinds,wait=0.2,settle=0" + settings).c_str());
    }
    /// How far the deepest vertex is in the ball [m].
    static double depth(const std::vector<float>& x) {
        double most = 0.0;
        for (std::size_t v = 0; v < x.size(); v += 3) {
            const double y = static_cast<double>(x[v + 1]) - 0.84;
            const double from_centre =
                std::hypot(static_cast<double>(x[v]), y, static_cast<double>(x[v + 2]));
            most = std::max(most, 0.15 - from_centre);
        }
        return most;
    }

    OneStep step_{kHanging + kBall, 12};
};

/// Obstacles that come last leave nothing inside; those that come when they come do: 0.31 mm. From
/// where the solver ends, 0.440 mm are left after 30 iterations, else 0.458 to 0.481.
TEST_F(WithABall, FourB) {
    for (const char* order : {"both", "within", "across"}) {
        EXPECT_LT(depth(after(8, std::string(",order=") + order)), 1e-6) << order;
    }
    EXPECT_GT(depth(after(8, ",order=free")), 1e-4);
    const auto end = step_.after(400, nullptr);
    const double best = distance(after(30, ""), end);
    for (const char* other : {",order=free", ",order=within", ",order=across", ",rank=off"}) {
        EXPECT_LT(best, distance(after(30, other), end)) << other;
    }
}

/// Where obstacles do not come last, half of what they move is lost in means: of positions (0.79 mm
/// inside), but of displacements, too (0.84 mm). Motions in full leave 0.31 mm.
TEST_F(WithABall, Seven) {
    const double in_full = depth(after(8, ",order=free"));
    EXPECT_GT(depth(after(8, ",order=free,merge=position")), 2.0 * in_full);
    EXPECT_GT(depth(after(8, ",order=free,merge=mean")), 2.0 * in_full);
    EXPECT_LT(depth(after(8, ",merge=position")), 1e-6);
}

}  // namespace
}  // namespace weft::test
