#pragma once

#include <optional>

#include "simulation/scene/scene.h"

namespace weft {

/// What stands in a scene for whichever solver serves it best (simulation/choice/solver_choice.h).
inline constexpr const char* kAutoMethod = "auto";

/// What such a scene says of its solver.
struct AutoMethod {
    std::optional<int> iterations;  ///< none: left out
};

/// By the scene's own words and overrides; none: it names its solver.
std::optional<AutoMethod> auto_method(const Scene& scene);

}  // namespace weft
