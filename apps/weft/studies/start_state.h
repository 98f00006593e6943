#pragma once

#include <filesystem>

#include "apps/weft/studies/error_problem.h"

namespace weft {

/// A state that an earlier run has left, at the start of `frame`.
struct StartState {
    State state;
    int frame = 0;
};

/// From a checkpoint (weft run --keep-checkpoint), exactly as it was; or from frames.vtkhdf, where
/// velocities are those that led there from the step before. frame: which, of the latter; null: the
/// last. scene: with its substeps. Throws UserError if the file is neither, or of another scene.
StartState read_start(const std::filesystem::path& path, const Scene& scene,
                      std::optional<int> frame);

}  // namespace weft
