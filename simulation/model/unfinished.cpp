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
constexpr double kSweepsOfBending = 1.25;  ///< measured: they do so much more than estimated

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
