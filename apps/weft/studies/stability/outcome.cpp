#include "apps/weft/studies/stability/outcome.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "runtime/error.h"
#include "simulation/checks/start_checks.h"
#include "simulation/checks/start_contacts.h"
#include "simulation/scene/read_scene.h"

namespace weft::stability {

namespace {

using Positions = std::vector<float>;  // xyz after xyz, scene order

/// In [-1, 1], the same on every machine.
class Random {
public:
    float next() {
        return static_cast<float>(static_cast<int>(engine_() % 20001) - 10000) / 10000.0f;
    }

private:
    std::mt19937 engine_{7};
};

float diagonal(const Positions& x) {
    float sum = 0.0f;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        float low = x[axis], high = x[axis];
        for (std::size_t i = axis; i < x.size(); i += 3) {
            low = std::min(low, x[i]);
            high = std::max(high, x[i]);
        }
        sum += (high - low) * (high - low);
    }
    return std::sqrt(sum);
}

/// One vertex, at random within `radius` of the origin, or on a sphere.
std::array<float, 3> scattered(Start start, float radius, Random& random) {
    std::array<float, 3> p{radius * random.next(), radius * random.next(), radius * random.next()};
    if (start == Start::kInPoint) return {};
    if (start == Start::kOnLine) p[1] = p[2] = 0.0f;
    if (start == Start::kInPlane) p[1] = 0.0f;
    if (start != Start::kOnSphere) return p;
    const float length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) + 1e-6f;
    for (float& value : p) value *= radius / length;
    return p;
}

Positions scattered_all(Start start, const Positions& rest) {
    Random random;
    Positions x;
    for (std::size_t i = 0; i < rest.size(); i += 3) {
        const auto p = scattered(start, 0.5f * diagonal(rest), random);
        x.insert(x.end(), p.begin(), p.end());
    }
    return x;
}

Positions scaled_along_x(Positions x, float factor) {
    for (std::size_t i = 0; i < x.size(); i += 3) x[i] *= factor;
    return x;
}

void start_as(Start start, Simulation& simulation) {
    if (start == Start::kAsWritten) return;
    const Positions rest = simulation.positions();
    Positions x = rest;
    Positions v(rest.size(), 0.0f);
    if (start == Start::kThrown) {
        for (std::size_t i = 1; i < v.size(); i += 3) v[i] = -1000.0f;
    } else if (start == Start::kInverted || start == Start::kStretched) {
        x = scaled_along_x(rest, start == Start::kInverted ? -1.0f : 100.0f);
    } else {
        x = scattered_all(start, rest);
    }
    simulation.start_from(0, x, v);
}

std::array<double, 3> centre(const Positions& x) {
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < x.size(); ++i) sum[i % 3] += static_cast<double>(x[i]);
    for (double& value : sum) value *= 3.0 / static_cast<double>(x.size());
    return sum;
}

/// By the steps that are taken, which add up to a little more than g t^2 / 2.
double free_fall(const Scene& scene, int frames) {
    const double h = scene.dt / scene.substeps;
    const double steps = static_cast<double>(frames) * scene.substeps;
    return 0.5 * length(scene.gravity) * h * h * steps * (steps + 1.0);
}

class CaseRun {
public:
    CaseRun(const Case& what, const std::string& solver, const RunOptions& options)
        : what_(what), options_(options) {
        outcome_.solver = solver;
    }

    Outcome run() {
        try {
            advance_all();
            judge();
        } catch (const UserError& refused) {
            stop(refused.what());
        } catch (const RunError& error) {
            stop(error.what());
        }
        return outcome_;
    }

private:
    void advance_all() {
        const Scene scene =
            parse_scene(what_.scene + fmt::format("\n[solver]\nmethod = \"{}\"\niterations = {}\n",
                                                  outcome_.solver, what_.iterations),
                        what_.group);
        SimulationOptions settings = options_.simulation();
        settings.on_trouble = OnTrouble::kReport;
        settings.cost_file.clear();
        Warnings of_devices;  // these say nothing of the scene
        simulation_ = std::make_unique<Simulation>(scene, settings, of_devices);
        Warnings warnings;
        warn_of_start(Model(scene, warnings), warnings);
        start_as(what_.start, *simulation_);
        first_ = simulation_->positions();
        rest_size_ = static_cast<double>(diagonal(first_));
        if (!warnings.empty()) hear(-1, warnings.front());
        std::vector<double> times;
        while (simulation_->frame() < scene.frames) {
            last_ = simulation_->advance({.tasks = false});
            times.push_back(last_.wall_time());
            had_ = std::max(had_, last_.kinetic_energy + std::abs(last_.gravity_energy));
            outcome_.strain_max = std::max(outcome_.strain_max, last_.strain_max);
        }
        std::ranges::nth_element(times, times.begin() + static_cast<long>(times.size() / 2));
        outcome_.ms_per_frame = 1e3 * times[times.size() / 2];
        outcome_.strain_rms = last_.strain_rms;
        if (!simulation_->troubles().empty()) {
            const Trouble& first = simulation_->troubles().front();
            hear(first.frame, first.what);
        }
    }

    void hear(int frame, const std::string& what) {
        if (outcome_.is_reported) return;
        outcome_.is_reported = true;
        outcome_.frame = frame;
        outcome_.said = what;
    }

    void stop(const std::string& what) {
        outcome_.verdict = Verdict::kStopped;
        if (simulation_) hear(simulation_->frame(), what);
        hear(-1, what);
    }

    double value_of(Quantity quantity) const {
        const Positions now = simulation_->positions();
        const auto from = centre(first_);
        const auto to = centre(now);
        const double size = std::max(rest_size_, 1e-30);
        switch (quantity) {
            case Quantity::kStrain:
                return last_.strain_rms;
            case Quantity::kWorst:
                return last_.strain_max;
            case Quantity::kFall:
                return (from[1] - to[1]) /
                       free_fall(simulation_->model().scene, simulation_->frame());
            case Quantity::kRise:
                return to[1] - from[1];
            case Quantity::kDrift:
                return std::hypot(to[0] - from[0], to[2] - from[2]) / size;
            case Quantity::kSize:
                return static_cast<double>(diagonal(now)) / size;
            case Quantity::kLost:
                return had_ > 0.0 ? last_.dissipated / had_ : 0.0;
            case Quantity::kCrossings:
                return static_cast<double>(
                    find_start_contacts(simulation_->model(), 0.0).crossings.size());
        }
        return 0.0;
    }

    /// Energy from nowhere is the run's own finding; the criterion is what should be seen.
    void judge() {
        for (const Bound& bound : what_.criterion) {
            const double value = value_of(bound.quantity);
            if (value >= bound.low && value <= bound.high) continue;
            outcome_.verdict = bound.otherwise;
            outcome_.why = fmt::format("{}: {:.3g}", text_of({bound}), value);
            break;
        }
        const auto explodes = [](const Trouble& t) { return t.is_explosion; };
        if (std::ranges::any_of(simulation_->troubles(), explodes)) {
            outcome_.verdict = Verdict::kExploded;
        } else if (outcome_.verdict == Verdict::kStable && !simulation_->troubles().empty()) {
            outcome_.verdict = Verdict::kUnconverged;
        }
    }

    const Case& what_;
    const RunOptions& options_;
    Outcome outcome_;
    std::unique_ptr<Simulation> simulation_;
    Positions first_;
    double rest_size_ = 0.0;  ///< [m]
    double had_ = 0.0;        ///< the most energy of motion and height that was seen [J]
    FrameRecord last_;
};

}  // namespace

Outcome run_case(const Case& what, const std::string& solver, const RunOptions& options) {
    return CaseRun(what, solver, options).run();
}

}  // namespace weft::stability
