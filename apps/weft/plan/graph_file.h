#pragma once

#include <string>
#include <vector>

#include "scheduler/task_graph.h"

namespace weft {

/// How text shows times; JSON has them as they are.
struct TimeUnit {
    double factor = 1.0;  ///< of the graph's times
    std::string name;     ///< empty: whatever the graph's author had in mind
};

/// A task graph and the names of its processors, as `weft plan` reads them from JSON:
///
///   { "processors": ["cpu", "gpu"],
///     "tasks": [ {"name": "a", "cost": [14, 16]}, {"name": "b", "cost": [13, null]} ],
///     "edges": [ ["a", "b", 18] ],
///     "latency": 0, "bandwidth": 1 }
///
/// A task may also have a "kind" and an "iteration", whole numbers from 0, for the paper's
/// adaptations (adaptations.h). latency and bandwidth may be left out; each is one number, or one
/// row per processor that data come from with one number per processor that they go to.
struct GraphFile {
    std::vector<std::string> processors;
    scheduler::TaskGraph graph{1};  ///< sealed
    TimeUnit unit = {};             ///< that times are shown in
};

/// Throws UserError with the file and the line and column, or the field, that is wrong.
GraphFile read_graph_file(const std::string& path);

}  // namespace weft
