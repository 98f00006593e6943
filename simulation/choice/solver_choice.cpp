#include "simulation/choice/solver_choice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <vector>

#include "runtime/error.h"
#include "simulation/choice/step_trials.h"
#include "simulation/model/substeps.h"
#include "simulation/scene/auto_method.h"
#include "simulation/scene/solver_limits.h"
#include "simulation/simulation.h"

namespace weft {

namespace {

constexpr double kUsualTolerance = 1e-2;
constexpr double kSecondsOfRun = 2.0;     ///< that lead to the step
constexpr double kSecondsOfTrials = 8.0;  ///< of each method, with all that it takes to set up

/// Newton, the first, is the one that may make the others' longest trials needless.
constexpr std::array kCandidates{Method::kNewton, Method::kVbd, Method::kJpgd, Method::kSosd,
                                 Method::kXpbd};

class Clock {
public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// As if it had been written so.
void set(Scene& scene, Method method, int iterations) {
    scene.solver.method = method;
    scene.solver.iterations = iterations;
    scene.overrides.push_back(fmt::format("solver.method={}", name_of(method)));
    scene.overrides.push_back(fmt::format("solver.iterations={}", iterations));
}

Scene with_method(Scene scene, Method method, int iterations) {
    set(scene, method, iterations);
    return scene;
}

/// Where the scene is at half of its frames, or as far as it gets in a while.
SubstepEnds lead_to_step(const Scene& scene) {
    constexpr int kIterations = 2;
    const Clock clock;
    SimulationOptions options;
    options.devices = "cpu";
    options.calibrate = false;
    options.plan = PlanKind::kSingle;
    options.on_trouble = OnTrouble::kIgnore;
    Warnings said_already;
    Simulation run(with_method(scene, Method::kNewton, kIterations), options, said_already);
    try {
        while (run.frame() < scene.frames / 2 && clock.seconds() < kSecondsOfRun) {
            run.advance({.tasks = false});
        }
    } catch (const RunError&) {
        // Then the step is the one from the last state that is one.
    }
    return {run.positions(), run.velocities(), {}, run.time(), {}};
}

/// What is wanted, and how many iterations it may take.
struct Limits {
    double error;
    int iterations;
};

struct Measured {
    Method method;
    int iterations = 0;
    StepTrials::Result result{};
};

/// Doubles a method's iterations until the step is solved, until it takes longer than `most`
/// seconds, or there is no time left.
Measured measure(StepTrials& trials, const Limits& limits, Method method, double most) {
    constexpr int kRepetitions = 3;
    const Clock clock;
    const int limit = std::min(limits.iterations, trials.most_iterations_of(method));
    Measured now{method, 1, trials.run(method, 1, kRepetitions)};
    Measured best = now;
    while (best.result.error > limits.error && 2 * now.iterations <= limit) {
        if (clock.seconds() > kSecondsOfTrials || now.result.seconds > most) break;
        now.iterations *= 2;
        now.result = trials.run(method, now.iterations, kRepetitions);
        if (now.result.error < best.result.error) best = now;
    }
    return best;
}

std::string text_of(const Measured& m) {
    return fmt::format("{} {:.2g} ms to {:.1g} ({} iteration{})", name_of(m.method),
                       1e3 * m.result.seconds, m.result.error, m.iterations,
                       m.iterations == 1 ? "" : "s");
}

/// Solved ones by their time, others by their error.
bool is_better(const Measured& a, const Measured& b, double wanted) {
    const bool a_solves = a.result.error <= wanted;
    const bool b_solves = b.result.error <= wanted;
    if (a_solves != b_solves) return a_solves;
    return a_solves ? a.result.seconds < b.result.seconds : a.result.error < b.result.error;
}

/// Where a tolerance chooses how many each frame takes, harder steps than this one may take more.
int iterations_for(const Measured& best, const Scene& scene, const Limits& limits) {
    constexpr int kMore = 4;
    if (scene.solver.tolerance == 0.0) return best.iterations;
    SolverSettings own = scene.solver;
    own.method = best.method;
    return std::min({kMore * best.iterations, limits.iterations, most_iterations(own)});
}

std::vector<Measured> measure_all(const Scene& scene, const SubstepEnds& start,
                                  const Limits& limits, PlanKind plan) {
    StepTrials trials(scene, start);
    std::vector<Measured> all;
    double most = std::numeric_limits<double>::infinity();
    for (const Method method : kCandidates) {
        // It has no asynchronous form.
        if (plan == PlanKind::kAsync && method == Method::kNewton) continue;
        all.push_back(measure(trials, limits, method, most));
        const StepTrials::Result& result = all.back().result;
        if (result.error <= limits.error) most = std::min(most, result.seconds);
    }
    return all;
}

SolverChoice choose_measured(const Scene& scene, const Limits& limits, PlanKind plan) {
    const SubstepEnds start = lead_to_step(scene);
    std::vector<Measured> all = measure_all(scene, start, limits, plan);
    if (std::ranges::all_of(all, [](const Measured& m) { return m.result.error == 0.0; })) {
        return {Method::kXpbd, scene.solver.iterations, scene.substeps,
                fmt::format("nothing is to be solved until {:.3g} s", start.time)};
    }
    std::ranges::sort(
        all, [&](const Measured& a, const Measured& b) { return is_better(a, b, limits.error); });
    std::vector<std::string> texts;
    for (const Measured& m : all) texts.push_back(text_of(m));
    return {all[0].method, iterations_for(all[0], scene, limits), scene.substeps,
            fmt::format("a step at {:.3g} s, on one core: {}", start.time, fmt::join(texts, ", "))};
}

}  // namespace

SolverChoice choose_solver(const Scene& given, PlanKind plan) {
    constexpr int kMost = 64;
    const auto wishes = auto_method(given).value_or(AutoMethod{});
    const int most = wishes.iterations.value_or(kMost);
    const int usual = std::min(SolverSettings{}.iterations, most);
    const Scene scene = with_substeps(with_method(given, Method::kVbd, usual));
    if (scene.contact) {
        return {Method::kVbd, usual, scene.substeps,
                "solvers are not compared on steps with [contact]"};
    }
    const double wanted = scene.solver.tolerance > 0.0 ? scene.solver.tolerance : kUsualTolerance;
    return choose_measured(scene, {wanted, most}, plan);
}

Scene with_choice(Scene scene, const SolverChoice& choice) {
    set(scene, choice.method, choice.iterations);
    scene.substeps = choice.substeps;
    scene.overrides.push_back(fmt::format("scene.substeps={}", choice.substeps));
    return scene;
}

std::string to_text(const SolverChoice& choice) {
    return fmt::format("{} {} {} {}", name_of(choice.method), choice.iterations, choice.substeps,
                       choice.why);
}

SolverChoice parse_solver_choice(const std::string& text) {
    std::istringstream in(text);
    std::string name;
    SolverChoice choice;
    in >> name >> choice.iterations >> choice.substeps;
    choice.method = method_named(name);
    std::getline(in >> std::ws, choice.why);
    return choice;
}

}  // namespace weft
