#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace weft {

/// Where things are kept that can be made again: $WEFT_CACHE_DIR, else weft below $XDG_CACHE_HOME
/// or ~/.cache. Empty where there is no place for it.
std::filesystem::path cache_folder();

/// Name of a cached file: the FNV-1a hash of everything that what it holds depends on.
std::string cache_key(std::string_view text);

/// Empty if it cannot be read.
std::string read_cached(const std::filesystem::path& path);
/// Whole or not at all: other processes may read and write the same file. A cache that cannot be
/// written is passed over.
void write_cached(const std::filesystem::path& path, std::string_view bytes);

}  // namespace weft
