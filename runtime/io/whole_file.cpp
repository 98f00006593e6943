#include "runtime/io/whole_file.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "runtime/error.h"

namespace weft {

namespace fs = std::filesystem;

namespace {

/// What cannot even be looked at fails when it is opened.
bool replaceable(const fs::path& path) {
    std::error_code unknown;
    return !fs::exists(path, unknown) || fs::is_regular_file(path, unknown);
}

}  // namespace

fs::path unfinished(const fs::path& path) { return path.string() + ".part"; }

WholeFile::WholeFile(fs::path path, std::string what, Writers writers)
    : path_(std::move(path)), part_(path_), what_(std::move(what)) {
    if (writers == Writers::kMany) {
        open_own();
        return;
    }
    if (replaceable(path_)) part_ = unfinished(path_);
    file_ = std::fopen(part_.c_str(), "wb");
    if (file_ == nullptr) fail(errno);
}

/// The file system itself finds a name that nobody has: on another machine, a process may have the
/// same number.
void WholeFile::open_own() {
    std::string name = path_.string() + ".XXXXXX";
    const int file = ::mkstemp(name.data());
    if (file < 0) fail(errno);
    ::fchmod(file, 0644);
    part_ = name;
    file_ = ::fdopen(file, "wb");
    if (file_ == nullptr) fail(errno);
}

WholeFile::~WholeFile() {
    if (file_ == nullptr) return;
    std::fclose(file_);
    remove_part();
}

void WholeFile::remove_part() const {
    std::error_code ignored;
    if (part_ != path_) fs::remove(part_, ignored);
}

void WholeFile::write(std::string_view bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail(errno);
}

void WholeFile::finish() {
    if (std::fflush(file_) != 0) fail(errno);
    const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
    if (closed && (part_ == path_ || std::rename(part_.c_str(), path_.c_str()) == 0)) return;
    const int reason = errno;
    remove_part();
    fail(reason);
}

void WholeFile::fail(int reason) const {
    throw RunError(path_.string() + ": cannot write" + what_ + ": " + std::strerror(reason));
}

void write_whole_file(const fs::path& path, std::string_view bytes, const std::string& what) {
    WholeFile file(path, what);
    file.write(bytes);
    file.finish();
}

}  // namespace weft
