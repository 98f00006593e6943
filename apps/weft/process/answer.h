#pragma once

#include <functional>
#include <string>

namespace weft {

/// What `work` returns or throws, as text that another process can be given.
std::string answer_of(const std::function<std::string()>& work);

bool is_failure(const std::string& answer);

/// What the work returned, of its answer. Throws UserError or RunError, as it did; `what` names it
/// in the latter.
std::string result_of(const std::string& answer, const std::string& what);

}  // namespace weft
