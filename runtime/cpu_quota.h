#pragma once

#include <filesystem>
#include <optional>

namespace weft {

/// How many processors' time the control groups of this process leave it, as containers and batch
/// systems set it: 1.5 is three seconds in two. None without a limit, or where there are no groups.
/// root  instead of /, for tests
std::optional<double> cpu_quota(const std::filesystem::path& root = "/");

}  // namespace weft
