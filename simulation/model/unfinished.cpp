#include "simulation/model/unfinished.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulation/model/reach.h"

namespace weft {

namespace {

constexpr double kStrainOfCloth = 0.005;
constexpr double kStrainOfSolids = 0.001;
constexpr double kExcessOfSag = 0.15;
/// That matter, in parts of the length; of solids as their strain, by how slender they are.
constexpr double kLeastSagOfCloth = 5e-4;
constexpr double kLeastSagOfSolids = 1e-4;
/// Cloth that is too soft to bear its weight hangs down, behind a bend as wide as its length over
/// the third root of 8 sag. So much less of that is let pass, in parts of the length.
constexpr double kLeastReach = 0.02;
constexpr double kExcessOfSpans = 0.05;
constexpr double kLeastSagOfSpans = 2e-3;  ///< that matters, in parts of the span
constexpr double kSweepsOfSpans = 1.5;     ///< measured: they do so much more than one by one
constexpr double kSweepsOfBending = 1.25;  ///< measured: they do so much more than estimated

/// As a strain, where the sag is as wide as the span.
double load_across(const LoadPath& path, double gravity) {
    return gravity * path.pull * path.span / (8.0 * path.wave * path.wave);
}

}  // namespace

double unfinished_strain(const LoadPath& path, double h, int iterations, double gravity) {
    const double edge = std::max(path.edge, 1e-9);
    return 2.0 * gravity * h * h * path.levels * path.burden / (iterations * edge);
}

double unfinished_sag(const LoadPath& path, double h, int iterations) {
    if (path.firmness <= 0.0) return 0.0;
    const double sweeps = kSweepsOfBending * 2.0 * iterations / (h * h * path.firmness);
    return 1.0 / std::expm1(std::min(sweeps, 700.0));
}

double sag_of_span(const LoadPath& path, double gravity, double stiffness) {
    constexpr int kSteps = 30;  // they are quadratic soon
    const double load = load_across(path, gravity) / stiffness;
    // Not below the root, from where Newton's method comes down to it.
    double x = std::cbrt(3.0 * load / 8.0) + std::sqrt(3.0 * std::max(path.slack, 0.0) / 8.0);
    for (int i = 0; i < kSteps; ++i) {
        const double slope = 8.0 * x * x - path.slack;
        if (slope <= 0.0) break;
        x -= ((8.0 / 3.0 * x * x - path.slack) * x - load) / slope;
    }
    return x;
}

double finished_stiffness(const LoadPath& path, double h, int iterations) {
    const double courant = path.wave * h / path.stride;
    const double ratio = 2.0 * courant * courant;
    return -std::expm1(-kSweepsOfSpans * iterations * std::log1p(1.0 / ratio));
}

double substeps_for_span(const LoadPath& path, double dt, int iterations, double gravity) {
    if (path.span <= 0.0 || path.wave <= 0.0 || gravity * path.pull <= 0.0) return 0.0;
    const double x = sag_of_span(path, gravity);
    const double most = std::max((1.0 + kExcessOfSpans) * x, x + kLeastSagOfSpans);
    const double wanted =
        load_across(path, gravity) / ((8.0 / 3.0 * most * most - path.slack) * most);
    const double ratio = 1.0 / std::expm1(-std::log1p(-wanted) / (kSweepsOfSpans * iterations));
    return dt * path.wave / path.stride / std::sqrt(0.5 * ratio);
}

double substeps_for_strain(const LoadPath& path, double dt, int iterations, double gravity) {
    const double wanted = path.is_solid ? kStrainOfSolids / path.slender : kStrainOfCloth;
    return std::sqrt(unfinished_strain(path, dt, iterations, gravity) / wanted);
}

double substeps_for_bending(const LoadPath& path, double dt, int iterations, double gravity) {
    const double sag = path.softness * gravity;
    if (sag <= 0.0 || path.firmness <= 0.0) return 0.0;
    const double least = path.is_solid ? std::max(kLeastSagOfSolids, kStrainOfSolids / path.slender)
                                       : kLeastSagOfCloth;
    double excess = std::max(kExcessOfSag, least / sag);
    if (!path.is_solid) {
        const double bent = kLeastReach * std::cbrt(8.0 * sag);
        if (bent >= 1.0) return 0.0;
        excess = std::max(excess, std::pow(1.0 - bent, -3.0) - 1.0);
    }
    const double sweeps = std::log1p(1.0 / excess);
    return dt * std::sqrt(path.firmness * sweeps / (kSweepsOfBending * 2.0 * iterations));
}

double substeps_of_rounding(double reach, double dt, double gravity) {
    constexpr double kAny = std::numeric_limits<double>::infinity();
    const double rounding = rounding_at(reach);
    if (rounding <= 0.0 || gravity <= 0.0) return kAny;
    return std::max(1.0, std::floor(dt * std::sqrt(kTooShortBy * gravity / rounding)));
}

}  // namespace weft
