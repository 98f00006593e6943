#pragma once

#include <functional>
#include <string>

namespace weft {

/// Runs `work` in a process of its own and returns its bytes: so drivers that are set up once per
/// process can be set up for each device list. Call it while this process has no threads. Throws
/// UserError or RunError, as the work did; `what` names it where the process died.
std::string in_child_process(const std::string& what, const std::function<std::string()>& work);

}  // namespace weft
