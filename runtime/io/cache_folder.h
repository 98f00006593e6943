#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace weft {

/// Where things are kept that can be made again: $WEFT_CACHE_DIR, else weft below $XDG_CACHE_HOME
/// or ~/.cache. Variables that are empty count as not set. Empty where there is no place for it.
std::filesystem::path cache_folder();

/// Why $WEFT_CACHE_DIR cannot serve as one, for a warning; empty: it can, or it is not set. Makes
/// the folder.
std::string cache_folder_trouble();

/// Name of a cached file: the FNV-1a hash of everything that what it holds depends on.
std::string cache_key(std::string_view text);

/// Empty if it cannot be read.
std::string read_cached(const std::filesystem::path& path);
/// Whole or not at all: other processes may read and write the same file. A cache that cannot be
/// written is passed over.
void write_cached(const std::filesystem::path& path, std::string_view bytes);

/// While one lives, others who ask for the same file's lock wait: for those who read a cached file,
/// change it and write it. File systems without locks let everyone in. It leaves an empty file
/// <path>.lock behind.
class CacheLock {
public:
    explicit CacheLock(const std::filesystem::path& path);
    ~CacheLock();
    CacheLock(const CacheLock&) = delete;
    CacheLock& operator=(const CacheLock&) = delete;

private:
    int file_ = -1;
};

}  // namespace weft
