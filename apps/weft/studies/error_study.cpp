#include "apps/weft/studies/error_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "apps/weft/studies/error_curve.h"
#include "apps/weft/studies/start_state.h"
#include "runtime/error.h"
#include "simulation/families/convert.h"
#include "simulation/model/substeps.h"
#include "simulation/reference/minimum_cache.h"

namespace weft {

namespace {

void check_solved(const Certificate& certificate) {
    if (certificate.relative_gap <= kSolvedGap) return;
    throw RunError(fmt::format(
        "the reference solver did not converge: after {} iterations {:.1e} of E0 - E* may be "
        "left to gain; a softer scene or more substeps may help",
        certificate.iterations, certificate.relative_gap));
}

int far_iterations(const ErrorOptions& options) { return 8 * options.max_iterations; }

/// With obstacles: of the distance from the end.
Minimum solve_with_obstacles(const ErrorOptions& options, ErrorProblem& problem) {
    problem.end = far_end(options, problem, far_iterations(options));
    Minimum minimum;
    minimum.x = problem.end;
    minimum.start_energy = problem.energy(problem.potential->predicted());
    return minimum;
}

Minimum solve(const ErrorOptions& options, ErrorProblem& problem) {
    if (options.obstacles) return solve_with_obstacles(options, problem);
    const auto tell = [&](const Certificate& c) {
        if (options.run.quiet) return;
        std::cerr << fmt::format("reference: {} iterations, {:.1e} of the energy left to gain\n",
                                 c.iterations, c.relative_gap);
    };
    Minimum minimum = find_minimum(
        *problem.potential, [&] { return good_guess(options, problem); }, tell);
    check_solved(minimum.certificate);
    return minimum;
}

/// Relative error of the minimiser with its positions rounded to float32.
double rounding_floor(const ErrorProblem& problem, const Minimum& minimum) {
    std::vector<Vec3> rounded = minimum.x;
    for (std::size_t v = 0; v < rounded.size(); ++v) {
        if (problem.potential->is_free(static_cast<int>(v))) {
            rounded[v] = to_vec3(to_float4(rounded[v]));
        }
    }
    return (problem.energy(rounded) - minimum.energy) / (minimum.start_energy - minimum.energy);
}

void check_options(const ErrorOptions& options) {
    if (options.max_iterations < 1) {
        throw UserError(
            fmt::format("--max-iterations {}: expected 1 or more", options.max_iterations));
    }
    // Wrong names are to be seen before anything is computed.
    for (const std::string& solver : options.solvers) {
        static_cast<void>(scene_of_step(options, solver, 1));
    }
    for (const std::string& plan : options.plans) {
        RunOptions run = options.run;
        run.plan = plan;
        static_cast<void>(run.simulation());
    }
}

/// Where the step begins: from a file, or by a run up to there.
StartState start_of(const ErrorOptions& options, const Scene& scene) {
    const int frame = options.frame.value_or(scene.frames / 2);
    if (!options.start && (frame < 0 || frame >= scene.frames)) {
        throw UserError(
            fmt::format("--frame {}: the scene has frames 0 to {}", frame, scene.frames - 1));
    }
    if (!options.start) return {state_at(options, scene, frame), frame};
    return read_start(*options.start, scene, options.frame);
}

/// E has a lower minimum than the one that Newton's method found where a curve got below it.
void look_below(ErrorStudy& study, ErrorProblem& problem, const MeasuredCurve& measured) {
    if (measured.least_energy() >= study.minimum.energy) return;
    Minimum lower = minimise(*problem.potential, problem.from_scene_order(measured.positions));
    check_solved(lower.certificate);
    study.minimum = std::move(lower);
    const std::string note = "E has several minima here; E* is the lowest that was found";
    if (std::ranges::find(study.notes, note) == study.notes.end()) study.notes.push_back(note);
}

void describe_contact(ErrorStudy& study, const ErrorOptions& options, const ErrorProblem& problem) {
    const bool rubs = problem.potential->rubs();
    study.energies.emplace_back("contact");
    if (rubs) study.energies.emplace_back("friction");
    study.notes.push_back(fmt::format(
        "the step has {} contacts, as they are where it begins{}",
        problem.potential->contacts().size(),
        rubs ? "; friction goes by what presses them together at the reference's end" : ""));
    if (options.planes) return;
    study.notes.emplace_back(
        "the planes that keep surfaces apart are no part of E, since they are inequalities; all "
        "solvers and the reference do this step without them (runs have them; --planes)");
}

/// What E is made of, and what of the scene is no part of it.
void describe(ErrorStudy& study, const ErrorOptions& options, const Scene& scene,
              const ErrorProblem& problem) {
    const Model& model = problem.model;
    if (options.obstacles) {
        study.energies = {"distance"};
        study.notes.push_back(
            fmt::format("obstacles are in the step; E is half the squared distance, weighted by "
                        "mass / h^2, from "
                        "where {} ends alone after {} iterations",
                        options.solvers.front(), far_iterations(options)));
        return;
    }
    study.energies = {"inertia"};
    for (const auto& family : model.families) {
        for (const std::string& part : family->parts()) study.energies.push_back(part);
    }
    if (scene.contact) describe_contact(study, options, problem);
    if (!scene.obstacles.empty()) {
        study.notes.emplace_back(
            "obstacles are no part of E, since contact is an inequality; all solvers and the "
            "reference do this step without them (the run up to it has them)");
    }
    if (model.damped) {
        study.notes.emplace_back(
            "damping is no part of E: it takes its part of the velocities after the step");
    }
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
    const Scene scene = with_substeps(read_scene(options.run.scene, options.run.overrides()));
    check_options(options);
    StartState start = start_of(options, scene);

    ErrorStudy study;
    study.scene = scene.name;
    study.frame = start.frame;
    study.step = scene.dt / scene.substeps;
    ErrorProblem problem(options, std::move(start.state), start.frame * scene.substeps);
    study.vertices = problem.model.vertex_count();
    describe(study, options, scene, problem);
    study.minimum = solve(options, problem);
    constexpr double kLostInRounding = 0.1;
    if (!(rounding_floor(problem, study.minimum) < kLostInRounding)) {
        throw UserError(
            fmt::format("{}: at frame {} there is nothing to solve: free motion is as "
                        "near to the minimum of E as float32 can tell; choose another "
                        "--frame",
                        options.run.scene, study.frame));
    }

    for (const std::string& solver : options.solvers) {
        for (const std::string& devices : options.devices) {
            for (const std::string& plan : options.plans) {
                RunOptions run = options.run;
                run.solver = solver;
                run.device = devices;
                run.plan = plan;
                if (!run.quiet) {
                    std::cerr << fmt::format("measuring {} on {} ({})\n", solver, devices, plan);
                }
                const MeasuredCurve measured = measure_curve(options, run, problem);
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
