#include "apps/weft/error_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <iostream>
#include <limits>
#include <memory>
#include <sstream>

#include "apps/weft/child_process.h"
#include "apps/weft/progress.h"
#include "runtime/error.h"
#include "simulation/model/convert.h"
#include "simulation/reference/minimum_cache.h"

namespace weft {

namespace {

/// A state as the simulation gives it: xyz in scene order.
struct State {
    std::vector<float> positions, velocities;
};

std::string to_bytes(const State& state) {
    std::string bytes(2 * state.positions.size() * sizeof(float), '\0');
    const std::size_t half = bytes.size() / 2;
    std::memcpy(bytes.data(), state.positions.data(), half);
    std::memcpy(bytes.data() + half, state.velocities.data(), half);
    return bytes;
}

State to_state(const std::string& bytes) {
    const std::size_t half = bytes.size() / 2;
    State state{std::vector<float>(half / sizeof(float)), std::vector<float>(half / sizeof(float))};
    std::memcpy(state.positions.data(), bytes.data(), half);
    std::memcpy(state.velocities.data(), bytes.data() + half, half);
    return state;
}

/// The state at the start of `frame`, from the whole scene with all that it has.
State state_at(const ErrorOptions& options, const Scene& scene, int frame) {
    if (frame == 0) {
        Warnings warnings;
        const Model model(scene, warnings);
        State state{std::vector<float>(3 * model.positions->count()),
                    std::vector<float>(3 * model.positions->count())};
        for (std::size_t v = 0; v < model.positions->count(); ++v) {
            const float4& x = (*model.positions)[v];
            float* to = &state.positions[3 * static_cast<std::size_t>(model.strips.order[v])];
            to[0] = x.x;
            to[1] = x.y;
            to[2] = x.z;
        }
        return state;
    }
    return to_state(in_child_process("the run up to the frame", [&] {
        Warnings warnings;
        RunOptions run = options.run;
        run.device = options.devices.front();
        Simulation simulation(scene, run.simulation(), warnings);
        Progress progress("frame", frame, options.run.quiet);
        for (int f = 0; f < frame; ++f) {
            simulation.advance();
            progress.show(f + 1);
        }
        return to_bytes({simulation.positions(), simulation.velocities()});
    }));
}

/// The scene of the step alone: one substep, no contact, and no guard, since what solvers pass
/// through on their way is to be seen.
Scene scene_of_step(const ErrorOptions& options, const std::string& solver, int iterations) {
    RunOptions run = options.run;
    run.solver = solver;
    Scene scene = read_scene(run.scene, run.overrides());
    scene.obstacles.clear();
    scene.dt /= scene.substeps;
    scene.substeps = 1;
    scene.solver.iterations = iterations;
    scene.guard.max_speed = scene.guard.max_strain = std::numeric_limits<double>::infinity();
    return scene;
}

void set_state(Model& model, const State& state) {
    for (std::size_t v = 0; v < model.positions->count(); ++v) {
        const std::size_t from = 3 * static_cast<std::size_t>(model.strips.order[v]);
        float4& x = (*model.positions)[v];
        float4& u = (*model.velocities)[v];
        x = {state.positions[from], state.positions[from + 1], state.positions[from + 2], x.w};
        u = {state.velocities[from], state.velocities[from + 1], state.velocities[from + 2], u.w};
    }
}

/// The step that all solvers are measured on.
struct Problem {
    Problem(const ErrorOptions& options, State state, int substep)
        : model(scene_of_step(options, options.solvers.front(), 1), warnings),
          first_substep(substep),
          start(std::move(state)) {
        set_state(model, start);
        potential = std::make_unique<IncrementalPotential>(model, substep * model.h);
    }

    /// Positions in scene order as the potential wants them. Held vertices are where they belong.
    std::vector<Vec3> from_scene_order(const std::vector<float>& positions) const {
        std::vector<Vec3> x = potential->predicted();
        for (std::size_t v = 0; v < x.size(); ++v) {
            if (!potential->is_free(static_cast<int>(v))) continue;
            const float* from = &positions[3 * static_cast<std::size_t>(model.strips.order[v])];
            x[v] = {from[0], from[1], from[2]};
        }
        return x;
    }

    Warnings warnings;
    Model model;
    int first_substep;  ///< since the run's beginning
    State start;
    std::unique_ptr<IncrementalPotential> potential;
};

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

/// What a curve's process hands over: one line per point, how it ended, and the last state.
struct Measured {
    std::vector<ErrorPoint> points;
    std::string end;
    std::vector<float> positions;

    std::string to_bytes() const {
        std::string bytes = end + '\n' + std::to_string(points.size()) + '\n';
        for (const ErrorPoint& p : points) {
            bytes += fmt::format("{} {} {}\n", p.iteration, p.time, p.energy);
        }
        return bytes + std::string(reinterpret_cast<const char*>(positions.data()),
                                   positions.size() * sizeof(float));
    }
    static Measured from_bytes(const std::string& bytes) {
        Measured measured;
        std::istringstream in(bytes);
        std::size_t count = 0;
        std::getline(in, measured.end);
        in >> count;
        measured.points.resize(count);
        for (ErrorPoint& p : measured.points) in >> p.iteration >> p.time >> p.energy;
        in.get();
        const auto at = static_cast<std::size_t>(in.tellg());
        measured.positions.resize((bytes.size() - at) / sizeof(float));
        std::memcpy(measured.positions.data(), bytes.data() + at, bytes.size() - at);
        return measured;
    }
};

/// The step with `iterations` iterations from the start, a few times: the state is the same each
/// time, the time is the median.
ErrorPoint measure_point(const ErrorOptions& options, const RunOptions& run, const Problem& problem,
                         int iterations, std::vector<float>& positions) {
    constexpr int kRepeats = 3;
    Warnings warnings;
    Simulation simulation(scene_of_step(options, *run.solver, iterations), run.simulation(),
                          warnings);
    std::vector<double> times;
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
        simulation.start_from(problem.first_substep, problem.start.positions,
                              problem.start.velocities);
        times.push_back(simulation.advance().measured_makespan);
    }
    positions = simulation.positions();
    const double energy = problem.potential->energy(problem.from_scene_order(positions));
    return {iterations, median(std::move(times)), energy, 0.0};
}

Measured measure_curve(const ErrorOptions& options, const RunOptions& run, const Problem& problem) {
    const auto now = std::chrono::steady_clock::now;
    auto begin = now();
    Measured measured;
    measured.end = fmt::format("--max-iterations {}", options.max_iterations);
    for (const int iterations : measured_iterations(options.max_iterations)) {
        if (std::chrono::duration<double>(now() - begin).count() > options.time) {
            measured.end = fmt::format("--time {:g}", options.time);
            break;
        }
        try {
            measured.points.push_back(
                measure_point(options, run, problem, iterations, measured.positions));
            if (iterations == 1) begin = now();  // kernels were compiled for the first one
        } catch (const RunError& error) {
            measured.end = error.what();
            break;
        }
    }
    return measured;
}

Minimum solve(Problem& problem, bool quiet) {
    const auto tell = [&](const Certificate& c) {
        if (quiet) return;
        std::cerr << fmt::format("reference: {} iterations, {:.1e} of the energy left to gain\n",
                                 c.iterations, c.relative_gap);
    };
    Minimum minimum = find_minimum(*problem.potential, tell);
    if (minimum.certificate.relative_gap > kSolvedGap) {
        throw RunError(fmt::format(
            "the reference solver did not converge: after {} iterations {:.1e} of E0 - E* may be "
            "left to gain; a softer scene or more substeps may help",
            minimum.certificate.iterations, minimum.certificate.relative_gap));
    }
    return minimum;
}

/// Relative error of the minimiser with its positions rounded to float32.
double rounding_floor(const Problem& problem, const Minimum& minimum) {
    std::vector<Vec3> rounded = minimum.x;
    for (std::size_t v = 0; v < rounded.size(); ++v) {
        if (problem.potential->is_free(static_cast<int>(v))) {
            rounded[v] = to_vec3(to_float4(rounded[v]));
        }
    }
    return (problem.potential->energy(rounded) - minimum.energy) /
           (minimum.start_energy - minimum.energy);
}

void check_options(const ErrorOptions& options, const Scene& scene, int frame) {
    if (frame < 0 || frame >= scene.frames) {
        throw UserError(
            fmt::format("--frame {}: the scene has frames 0 to {}", frame, scene.frames - 1));
    }
    if (options.max_iterations < 1) {
        throw UserError(
            fmt::format("--max-iterations {}: expected 1 or more", options.max_iterations));
    }
    // Wrong names are to be seen before anything is computed.
    for (const std::string& solver : options.solvers) scene_of_step(options, solver, 1);
    for (const std::string& plan : options.plans) {
        RunOptions run = options.run;
        run.plan = plan;
        static_cast<void>(run.simulation());
    }
}

/// E has a lower minimum than the one that Newton's method found where a curve got below it.
void look_below(ErrorStudy& study, Problem& problem, const Measured& measured) {
    if (measured.points.empty() || measured.points.back().energy >= study.minimum.energy) return;
    Minimum lower = minimise(*problem.potential, problem.from_scene_order(measured.positions));
    if (lower.energy >= study.minimum.energy) return;
    study.minimum = std::move(lower);
    study.notes.push_back("E has several minima here; E* is the lowest that was found");
}

void finish(ErrorStudy& study) {
    const double best = study.minimum.energy;
    const double start = study.minimum.start_energy;
    const auto relative = [&](double energy) { return (energy - best) / (start - best); };
    for (ErrorCurve& curve : study.curves) {
        curve.points.insert(curve.points.begin(), ErrorPoint{0, 0.0, start, 1.0});
        for (ErrorPoint& point : curve.points) point.relative_error = relative(point.energy);
    }
}

}  // namespace

std::vector<int> measured_iterations(int most) {
    std::vector<int> list;
    for (int k = 1; k < most; k = std::max(k + 1, static_cast<int>(std::lround(1.19 * k)))) {
        list.push_back(k);
    }
    list.push_back(most);
    return list;
}

const ErrorPoint* first_below(const ErrorCurve& curve, double error) {
    const auto at = std::ranges::find_if(
        curve.points, [&](const ErrorPoint& p) { return p.relative_error <= error; });
    return at == curve.points.end() ? nullptr : &*at;
}

ErrorStudy study_errors(const ErrorOptions& options) {
    const Scene scene = read_scene(options.run.scene, options.run.overrides());
    const int frame = options.frame.value_or(scene.frames / 2);
    check_options(options, scene, frame);

    ErrorStudy study;
    study.scene = scene.name;
    study.frame = frame;
    study.step = scene.dt / scene.substeps;
    if (!scene.obstacles.empty()) {
        study.notes.emplace_back(
            "the step is solved without obstacles: contact is an inequality, and no part of E");
    }
    Problem problem(options, state_at(options, scene, frame), frame * scene.substeps);
    study.vertices = problem.model.vertex_count();
    study.minimum = solve(problem, options.run.quiet);
    constexpr double kLostInRounding = 0.1;
    if (!(rounding_floor(problem, study.minimum) < kLostInRounding)) {
        throw UserError(
            fmt::format("{}: at frame {} there is nothing to solve: free motion is as "
                        "near to the minimum of E as float32 can tell; choose another "
                        "--frame",
                        options.run.scene, frame));
    }

    for (const std::string& solver : options.solvers) {
        for (const std::string& devices : options.devices) {
            for (const std::string& plan : options.plans) {
                RunOptions run = options.run;
                run.solver = solver;
                run.device = devices;
                run.plan = plan;
                const std::string what = fmt::format("{} on {}", solver, devices);
                if (!run.quiet) std::cerr << fmt::format("measuring {} ({})\n", what, plan);
                const Measured measured = Measured::from_bytes(in_child_process(
                    what, [&] { return measure_curve(options, run, problem).to_bytes(); }));
                look_below(study, problem, measured);
                study.curves.push_back({solver, devices, plan, measured.points, measured.end});
            }
        }
    }
    study.rounding_floor = rounding_floor(problem, study.minimum);
    finish(study);
    return study;
}

}  // namespace weft
