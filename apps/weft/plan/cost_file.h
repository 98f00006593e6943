#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "runtime/trace/recorded_graph.h"

namespace weft {

/// The costs of a machine, as `weft plan TRACE.h5 --costs FILE` reads and --print-costs writes them
/// (docs/traces.md):
///
///   { "devices": ["cpu", "gpu"],
///     "costs": { "predict": [ {"fixed": 2e-6, "per_item": 1.5e-9}, null ], ... },
///     "latency": 5e-5, "bandwidth": 1e10 }
///
/// A kind has one entry per device, null where the device cannot run it: seconds = fixed + per_item
/// * items. latency [s] and bandwidth [bytes/s] are as in a task graph (graph_file.h); left out,
/// latency is 0 and bandwidth infinite.
///
/// kinds  that the trace has; the file must name each of them, and no others. Throws UserError.
MachineCosts read_cost_file(const std::string& path, const std::vector<std::string>& kinds);

nlohmann::ordered_json to_json(const MachineCosts& costs, const std::vector<std::string>& kinds);

}  // namespace weft
