#include "apps/weft/error_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <span>
#include <sstream>

#include "apps/weft/child_process.h"
#include "apps/weft/comparison.h"
#include "runtime/error.h"

namespace weft {

namespace {

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

std::string to_bytes(const MeasuredCurve& curve) {
    std::string bytes = curve.end + '\n' + std::to_string(curve.points.size()) + '\n';
    for (const ErrorPoint& p : curve.points) {
        bytes += fmt::format("{} {} {}\n", p.iteration, p.time, p.energy);
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
    for (ErrorPoint& p : curve.points) in >> p.iteration >> p.time >> p.energy;
    in.get();
    const auto at = static_cast<std::size_t>(in.tellg());
    curve.positions.resize((bytes.size() - at) / sizeof(float));
    std::ranges::copy(std::as_bytes(std::span(bytes)).subspan(at),
                      std::as_writable_bytes(std::span(curve.positions)).begin());
    return curve;
}

/// The step with `iterations` iterations from the start, a few times: the state is the same each
/// time, the time is the median.
ErrorPoint measure_point(const ErrorOptions& options, const RunOptions& run,
                         const ErrorProblem& problem, int iterations,
                         std::vector<float>& positions) {
    constexpr int kRepeats = 3;
    Warnings warnings;
    SimulationOptions how = run.simulation();
    // There is nothing to plan for one device.
    how.calibrate = run.device == "hybrid" || devices_of(run.device).size() > 1;
    Simulation simulation(scene_of_step(options, *run.solver, iterations), how, warnings);
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

MeasuredCurve measure_points(const ErrorOptions& options, const RunOptions& run,
                             const ErrorProblem& problem) {
    const auto now = std::chrono::steady_clock::now;
    const double limit = options.time.value_or(10.0);
    auto begin = now();
    MeasuredCurve measured;
    measured.end = fmt::format("--max-iterations {}", options.max_iterations);
    for (const int iterations : measured_iterations(options.max_iterations)) {
        if (std::chrono::duration<double>(now() - begin).count() > limit) {
            measured.end = fmt::format("--time {:g}", limit);
            break;
        }
        try {
            std::vector<float> positions;
            const ErrorPoint point = measure_point(options, run, problem, iterations, positions);
            measured.add(point, std::move(positions));
            if (iterations == 1) begin = now();  // kernels were compiled for the first one
        } catch (const RunError& error) {
            measured.end = error.what();
            break;
        }
    }
    return measured;
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

MeasuredCurve measure_curve(const ErrorOptions& options, const RunOptions& run,
                            const ErrorProblem& problem) {
    return to_curve(in_child_process(fmt::format("{} on {}", *run.solver, run.device), [&] {
        return to_bytes(measure_points(options, run, problem));
    }));
}

}  // namespace weft
