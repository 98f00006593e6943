#include "apps/weft/studies/error_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <sstream>

#include "apps/weft/process/child_process.h"
#include "apps/weft/studies/repeated_time.h"
#include "apps/weft/timing/comparison.h"
#include "runtime/error.h"
#include "simulation/checks/step_error.h"
#include "simulation/scene/solver_limits.h"

namespace weft {

namespace {

std::string to_bytes(const MeasuredCurve& curve) {
    std::string bytes = curve.end + '\n' + std::to_string(curve.points.size()) + '\n';
    for (const ErrorPoint& p : curve.points) {
        // Streams read no NaN.
        const double estimate = std::isnan(p.estimate) ? -1.0 : p.estimate;
        bytes +=
            fmt::format("{} {} {} {} {}\n", p.iteration, p.time, p.energy, estimate, p.truncated);
    }
    return bytes + std::string(reinterpret_cast<const char*>(curve.positions.data()),
                               curve.positions.size() * sizeof(float));
}

MeasuredCurve to_curve(const std::string& bytes) {
    MeasuredCurve curve;
    std::istringstream in(bytes);
    std::size_t count = 0;
    std::getline(in, curve.end);
    in >> count;
    curve.points.resize(count);
    for (ErrorPoint& p : curve.points) {
        in >> p.iteration >> p.time >> p.energy >> p.estimate >> p.truncated;
        if (p.estimate < 0.0) p.estimate = ErrorPoint{}.estimate;
    }
    in.get();
    const auto at = static_cast<std::size_t>(in.tellg());
    curve.positions.resize((bytes.size() - at) / sizeof(float));
    std::ranges::copy(std::as_bytes(std::span(bytes)).subspan(at),
                      std::as_writable_bytes(std::span(curve.positions)).begin());
    return curve;
}

/// Of all the time for a curve, what repeats of one point may take.
constexpr double kShareOfPoint = 0.05;

bool has_choice(const RunOptions& run) {
    return run.device == "hybrid" || devices_of(run.device).size() > 1;
}

/// The step with so many iterations from the start, again and again: the state is the same each
/// time. Before the clock starts, data is in the caches and the plan has found its balance.
class RepeatedStep {
public:
    RepeatedStep(const ErrorOptions& options, const RunOptions& run, const ErrorProblem& problem,
                 int iterations)
        : problem_(problem),
          simulation_(scene_of_step(options, *run.solver, iterations), how(run), warnings_) {
        constexpr int kFramesToBalance = 8;
        const int warm_up = has_choice(run) ? kFramesToBalance : 1;
        for (int frame = 0; frame < warm_up; ++frame) advance();
    }

    /// Gives what the substep took [s].
    double advance() {
        simulation_.start_from(problem_.first_substep, problem_.start.positions,
                               problem_.start.velocities);
        const FrameRecord frame = simulation_.advance({.tasks = false});
        truncated_ =
            frame.contacts.empty() ? 0 : static_cast<int>(frame.contacts.front().truncated);
        return frame.measured_makespan;
    }
    /// Vertices that contact's planes took back.
    int truncated() const { return truncated_; }
    std::vector<float> positions() const { return simulation_.positions(); }

private:
    static SimulationOptions how(const RunOptions& run) {
        SimulationOptions options = run.simulation();
        options.on_trouble = OnTrouble::kIgnore;
        options.calibrate = has_choice(run);  // there is nothing to plan for one device
        return options;
    }

    const ErrorProblem& problem_;
    Warnings warnings_;
    Simulation simulation_;
    int truncated_ = 0;
};

/// Measures as many points as the time allows. Only measuring counts: building kernels, setting up
/// and warming up do not.
class CurveMeasurement {
public:
    CurveMeasurement(const ErrorOptions& options, const RunOptions& run,
                     const ErrorProblem& problem)
        : options_(options), run_(run), problem_(problem) {}

    MeasuredCurve measure() {
        const SolverSettings solver = scene_of_step(options_, *run_.solver, 1).solver;
        const int most = std::min(options_.max_iterations, most_iterations(solver));
        measured_.end = most < options_.max_iterations
                            ? fmt::format("as many as {} takes", name_of(solver.method))
                            : fmt::format("--max-iterations {}", most);
        for (const int iterations : measured_iterations(most)) {
            if (spent_ > limit_) {
                measured_.end = fmt::format("--time {:g}", limit_);
                break;
            }
            try {
                add_point(iterations);
            } catch (const RunError& error) {
                measured_.end = error.what();
                break;
            }
        }
        return std::move(measured_);
    }

private:
    void add_point(int iterations) {
        RepeatedStep step(options_, run_, problem_, iterations);
        RepeatedTime time(kShareOfPoint * limit_);
        while (!time.is_settled()) time.add(step.advance());
        spent_ += time.total();
        auto positions = step.positions();
        const double energy = problem_.energy(problem_.from_scene_order(positions));
        // More iterations never take less: what is left of the noise is no news.
        const double before = measured_.points.empty() ? 0.0 : measured_.points.back().time;
        const double estimate = estimate_of(positions);
        measured_.add(
            {iterations, std::max(before, time.median()), energy, 0.0, estimate, step.truncated()},
            std::move(positions));
    }

    /// Runs estimate E's error.
    double estimate_of(const std::vector<float>& positions) {
        if (!problem_.end.empty()) return std::numeric_limits<double>::quiet_NaN();
        const State& start = problem_.start;
        const double time = problem_.first_substep * problem_.model.h;
        return estimate_
            .of({start.positions, start.velocities, positions, time, {}, problem_.contacts})
            .value_or(std::numeric_limits<double>::quiet_NaN());
    }

    const ErrorOptions& options_;
    const RunOptions& run_;
    const ErrorProblem& problem_;
    const double limit_ = options_.time.value_or(10.0);
    double spent_ = 0.0;  ///< [s]
    StepError estimate_{problem_.model.scene, 1};
    MeasuredCurve measured_;
};

/// Of one step by a solver, on the CPU alone.
std::vector<Vec3> end_of(const ErrorOptions& options, const ErrorProblem& problem,
                         const std::string& solver, int iterations) {
    RunOptions run = options.run;
    run.solver = solver;
    run.device = "cpu";
    run.plan = "single";
    const auto most = most_iterations(scene_of_step(options, solver, 1).solver);
    const MeasuredCurve reached = to_curve(in_child_process(solver + " on cpu", [&] {
        RepeatedStep step(options, run, problem, std::min(iterations, most));
        step.advance();
        MeasuredCurve end;
        end.positions = step.positions();
        return to_bytes(end);
    }));
    return problem.from_scene_order(reached.positions);
}

}  // namespace

void MeasuredCurve::add(const ErrorPoint& point, std::vector<float> at) {
    if (point.energy < least_energy()) positions = std::move(at);
    points.push_back(point);
}

double MeasuredCurve::least_energy() const {
    double least = std::numeric_limits<double>::infinity();
    for (const ErrorPoint& p : points) least = std::min(least, p.energy);
    return least;
}

std::vector<Vec3> good_guess(const ErrorOptions& options, const ErrorProblem& problem) {
    constexpr int kIterations = 40;
    try {
        const bool has_contacts = problem.model.scene.contact.has_value();
        return end_of(options, problem, has_contacts ? "vbd" : "newton", kIterations);
    } catch (const RunError&) {
        return {};
    }
}

std::vector<Vec3> far_end(const ErrorOptions& options, const ErrorProblem& problem,
                          int iterations) {
    return end_of(options, problem, options.solvers.front(), iterations);
}

MeasuredCurve measure_curve(const ErrorOptions& options, const RunOptions& run,
                            const ErrorProblem& problem) {
    return to_curve(in_child_process(fmt::format("{} on {}", *run.solver, run.device), [&] {
        return to_bytes(CurveMeasurement(options, run, problem).measure());
    }));
}

}  // namespace weft
