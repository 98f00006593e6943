#pragma once

#include <string>

#include "apps/weft/run/run_options.h"

namespace weft {

/// What the results depend on, of what the user wrote: the scene as it was read, before a solver
/// was chosen for it. The number of frames may differ.
std::string request_text(const RunOptions& options, const Scene& scene);

/// All that the results depend on, in one line: a run goes on only from a checkpoint of the same.
/// request: as above. Throws UserError where a mesh cannot be read.
std::string run_origin(const std::string& request, const RunOptions& options, const Scene& scene,
                       const Simulation& simulation);

}  // namespace weft
