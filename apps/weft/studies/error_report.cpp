#include "apps/weft/studies/error_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>

namespace weft {

namespace {

constexpr std::array<double, 3> kGoals = {1e-1, 1e-2, 1e-3};

std::string goal_text(const ErrorCurve& curve, double goal) {
    const ErrorPoint* point = first_below(curve, goal);
    if (!point) return "-";
    return fmt::format("{:.3f} ms / {}", 1e3 * point->time, point->iteration);
}

/// With what the curves say: where planes are in the way, E* may be out of reach.
std::vector<std::string> notes_of(const ErrorStudy& study) {
    std::vector<std::string> held;
    for (const ErrorCurve& curve : study.curves) {
        const int truncated = curve.points.back().truncated;
        if (truncated == 0) continue;
        held.push_back(
            fmt::format("{} on {} ({}): {}", curve.solver, curve.devices, curve.plan, truncated));
    }
    std::vector<std::string> notes = study.notes;
    if (held.empty()) return notes;
    notes.push_back(fmt::format(
        "the planes that keep surfaces apart are no part of E; where these curves end "
        "vertices have gone farther than the nearest of theirs is away, of {}: {}; what "
        "planes hold back counts as error",
        study.vertices, fmt::join(held, ", ")));
    return notes;
}

}  // namespace

std::string to_csv(const ErrorStudy& study) {
    std::string csv =
        "solver,device,plan,iteration,time_s,energy,relative_error,relative_error_estimate,"
        "truncated\n";
    for (const ErrorCurve& curve : study.curves) {
        for (const ErrorPoint& point : curve.points) {
            const std::string estimate =
                std::isnan(point.estimate) ? "" : fmt::format("{}", point.estimate);
            csv += fmt::format("{},{},{},{},{},{},{},{},{}\n", curve.solver, curve.devices,
                               curve.plan, point.iteration, point.time, point.energy,
                               point.relative_error, estimate, point.truncated);
        }
    }
    return csv;
}

std::string to_text(const ErrorStudy& study) {
    const Minimum& minimum = study.minimum;
    std::string text = fmt::format(
        "{}, frame {}: one step of {:g} ms, {} vertices\n"
        "E: {}\n"
        "reference: E0 = {:.9g} J, E* = {:.9g} J, {:.1e} of E0 - E* left to gain, gradient {:.1e} "
        "of the forces in it\n"
        "float32 rounds the reference itself to a relative error of {:.1e}\n",
        study.scene, study.frame, 1e3 * study.step, study.vertices, fmt::join(study.energies, ", "),
        minimum.start_energy, minimum.energy, minimum.certificate.relative_gap,
        minimum.certificate.relative_gradient, study.rounding_floor);
    for (const std::string& note : notes_of(study)) text += "note: " + note + '\n';
    text += fmt::format("\n{:<8}{:<24}{:<8}{:>18}{:>18}{:>18}{:>12}\n", "solver", "devices", "plan",
                        "to 1e-1", "to 1e-2", "to 1e-3", "reached");
    for (const ErrorCurve& curve : study.curves) {
        text += fmt::format("{:<8}{:<24}{:<8}", curve.solver, curve.devices, curve.plan);
        for (const double goal : kGoals) text += fmt::format("{:>18}", goal_text(curve, goal));
        text +=
            fmt::format("{:>12.1e}  after {} iterations, {}\n", curve.points.back().relative_error,
                        curve.points.back().iteration, curve.end);
    }
    return text;
}

nlohmann::ordered_json to_json(const ErrorStudy& study) {
    nlohmann::ordered_json curves = nlohmann::ordered_json::array();
    for (const ErrorCurve& curve : study.curves) {
        nlohmann::ordered_json goals = nlohmann::ordered_json::object();
        for (const double goal : kGoals) {
            const ErrorPoint* point = first_below(curve, goal);
            goals[fmt::format("{:g}", goal)] =
                point ? nlohmann::ordered_json{{"time_s", point->time},
                                               {"iterations", point->iteration}}
                      : nlohmann::ordered_json(nullptr);
        }
        curves.push_back({{"solver", curve.solver},
                          {"devices", curve.devices},
                          {"plan", curve.plan},
                          {"iterations", curve.points.back().iteration},
                          {"energy", curve.points.back().energy},
                          {"relative_error", curve.points.back().relative_error},
                          {"truncated", curve.points.back().truncated},
                          {"end", curve.end},
                          {"to", goals}});
    }
    const Certificate& certificate = study.minimum.certificate;
    return {{"scene", study.scene},
            {"frame", study.frame},
            {"vertices", study.vertices},
            {"step", study.step},
            {"energies", study.energies},
            {"start_energy", study.minimum.start_energy},
            {"reference_energy", study.minimum.energy},
            {"certificate",
             {{"relative_gradient", certificate.relative_gradient},
              {"relative_gap", certificate.relative_gap},
              {"iterations", certificate.iterations}}},
            {"rounding_floor", study.rounding_floor},
            {"notes", notes_of(study)},
            {"curves", curves}};
}

}  // namespace weft
