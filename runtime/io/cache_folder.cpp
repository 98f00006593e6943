#include "runtime/io/cache_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <system_error>

#include "runtime/error.h"
#include "runtime/io/system_call.h"
#include "runtime/io/whole_file.h"

namespace weft {

namespace fs = std::filesystem;

namespace {

/// Empty counts as not set, as the XDG specification has it.
const char* folder_named_by(const char* variable) {
    const char* value = std::getenv(variable);
    return value == nullptr || *value == '\0' ? nullptr : value;
}

}  // namespace

fs::path cache_folder() {
    if (const char* own = folder_named_by("WEFT_CACHE_DIR")) return own;
    if (const char* xdg = folder_named_by("XDG_CACHE_HOME")) return fs::path(xdg) / "weft";
    if (const char* home = folder_named_by("HOME")) return fs::path(home) / ".cache" / "weft";
    return {};
}

std::string cache_folder_trouble() {
    const char* own = folder_named_by("WEFT_CACHE_DIR");
    if (own == nullptr) return "";
    std::error_code error;
    fs::create_directories(own, error);
    if (!error && ::access(own, W_OK | X_OK) != 0) error = {errno, std::generic_category()};
    if (!error) return "";
    return std::string("WEFT_CACHE_DIR=") + own + " cannot be used (" + error.message() +
           "): OpenCL's kernels and measured costs are not kept for the next run";
}

std::string cache_key(std::string_view text) {
    std::uint64_t hash = 14695981039346656037ULL;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
    char name[17];
    std::snprintf(name, sizeof name, "%016llx", static_cast<unsigned long long>(hash));
    return name;
}

std::string read_cached(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void write_cached(const fs::path& path, std::string_view bytes) {
    std::error_code ignored;
    fs::create_directories(path.parent_path(), ignored);
    try {
        WholeFile file(path, "", WholeFile::Writers::kMany);
        file.write(bytes);
        file.finish();
    } catch (const RunError&) {
        // passed over: what is cached can be made again
    }
}

CacheLock::CacheLock(const fs::path& path) {
    std::error_code ignored;
    fs::create_directories(path.parent_path(), ignored);
    file_ = ::open((path.string() + ".lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (file_ >= 0) until_uninterrupted([&] { return ::flock(file_, LOCK_EX); });
}

CacheLock::~CacheLock() {
    if (file_ >= 0) ::close(file_);
}

}  // namespace weft
