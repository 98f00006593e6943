#pragma once

#include <vector>

#include "runtime/planning/division.h"
#include "runtime/trace/recorded_graph.h"

namespace weft {

/// The tasks and the graph of a recorded frame if its strips were divided otherwise, among the
/// devices of `costs`; for rebuild_graph().
///
/// strips  per device; empty: the division that is planned to take least (every task at home, in
///         the solver's order, as runs plan it), found by a hill climb from shares in proportion to
///         the devices' speeds, single devices included
/// Makes the scene of the trace anew: its mesh files must be there. Throws UserError.
FrameRecord divide_anew(const RunDescription& run, const MachineCosts& costs,
                        const std::vector<int>& strips);

}  // namespace weft
