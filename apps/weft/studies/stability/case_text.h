#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace weft::stability {

inline constexpr double kNone = std::numeric_limits<double>::infinity();

/// A length of steps, as frames of so many substeps.
struct Steps {
    double dt;  ///< [s]
    int substeps;

    double length() const { return dt / substeps; }
};
inline constexpr Steps kSteps[] = {{1.0 / 12, 1},  {1.0 / 60, 1},  {1.0 / 60, 4},
                                   {1.0 / 60, 16}, {1.0 / 60, 64}, {1.0 / 60, 167}};
inline constexpr Steps kUsual{1.0 / 60, 16};

inline std::string head(const Steps& steps, double seconds, const std::string& more = "") {
    return fmt::format("[scene]\nframes = {}\ndt = {:.9g}\nsubsteps = {}\n{}\n",
                       std::max(1, static_cast<int>(std::lround(seconds / steps.dt))), steps.dt,
                       steps.substeps, more);
}

inline std::string step_text(const Steps& steps) {
    return fmt::format("h = {:.3g} ms", 1e3 * steps.length());
}

}  // namespace weft::stability
