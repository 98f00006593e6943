#include "runtime/cache_folder.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

namespace weft {

namespace fs = std::filesystem;

fs::path cache_folder() {
    if (const char* own = std::getenv("WEFT_CACHE_DIR")) return own;
    if (const char* xdg = std::getenv("XDG_CACHE_HOME")) return fs::path(xdg) / "weft";
    if (const char* home = std::getenv("HOME")) return fs::path(home) / ".cache" / "weft";
    return {};
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
    const fs::path part = path.string() + "." + std::to_string(::getpid());
    {
        std::ofstream out(part, std::ios::binary);
        out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        if (!out.flush()) {
            fs::remove(part, ignored);
            return;
        }
    }
    fs::rename(part, path, ignored);
    if (ignored) fs::remove(part, ignored);
}

}  // namespace weft
