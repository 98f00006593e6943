#include "apps/weft/run/output_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "runtime/error.h"
#include "runtime/io/whole_file.h"
#include "runtime/trace/trace_reader.h"
#include "simulation/output/checkpoint.h"
#include "simulation/output/geometry_writer.h"

namespace weft {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(const fs::path& path, const std::string& why) {
    throw UserError("--out " + path.string() + ": " + why);
}

/// A discarded value if it cannot be read.
nlohmann::json read_json(const fs::path& path) {
    std::ifstream stream(path);
    return nlohmann::json::parse(stream, nullptr, /*allow_exceptions=*/false);
}

/// A summary that cannot be read counts as finished: better to refuse than to overwrite.
bool is_finished(const fs::path& summary) {
    if (!fs::exists(summary)) return false;
    const auto json = read_json(summary);
    return !(json.is_object() && json.contains("finished") && json["finished"] == false);
}

/// The folder itself, or the nearest one above it that is there.
fs::path nearest_existing(fs::path path) {
    path = fs::absolute(path);
    std::error_code ignored;
    while (!fs::exists(path, ignored) && path.has_relative_path()) path = path.parent_path();
    return path;
}

/// File systems without locks let everyone in.
bool try_lock(int descriptor) {
    return ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

[[noreturn]] void refuse_as_busy(const fs::path& path) {
    refuse(path, "another run is writing there; choose another folder");
}

/// Without keeping it.
void check_that_nobody_writes(const fs::path& path) {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    const bool is_free = try_lock(descriptor);
    ::close(descriptor);
    if (!is_free) refuse_as_busy(path);
}

void check_length(const fs::path& path) {
    std::error_code error;
    static_cast<void>(fs::status(path / "frames.vtkhdf", error));
    if (error == std::errc::filename_too_long) refuse(path, error.message());
}

void check_writable(const fs::path& path) {
    const fs::path there = nearest_existing(path);
    if (!fs::is_directory(there)) refuse(path, "'" + there.string() + "' is not a folder");
    if (::access(there.c_str(), W_OK | X_OK) != 0) {
        refuse(path, "'" + there.string() + "' cannot be written: " + std::strerror(errno) +
                         "; choose another folder");
    }
}

}  // namespace

OutputFolder::OutputFolder(fs::path path, EarlierOutput earlier) : path_(std::move(path)) {
    check_length(path_);
    refuse_to_replace(earlier);
    check_writable(path_);
    replaces_unfinished_ =
        !is_finished(summary()) &&
        (fs::exists(trace()) || fs::exists(geometry()) || fs::exists(checkpoint()));
}

/// What failed before its first checkpoint is replaced: whoever works on a scene does so all the
/// time.
void OutputFolder::refuse_to_replace(EarlierOutput earlier) const {
    if (earlier == EarlierOutput::kReplace) return;
    if (earlier == EarlierOutput::kKeep && has_finished()) refuse_finished();
    if (earlier == EarlierOutput::kKeep && fs::exists(checkpoint())) {
        check_that_nobody_writes(path_);
        refuse(path_,
               "a run that did not finish is there; --resume goes on with it, --force overwrites "
               "it, another --out keeps it");
    }
}

bool OutputFolder::has_finished() const { return is_finished(summary()); }

void OutputFolder::refuse_finished() const {
    refuse(path_, "a finished run is there; --force overwrites it, another --out keeps it");
}

std::string OutputFolder::unfinished_scene() const {
    if (!replaces_unfinished_) return "";
    if (fs::exists(summary())) {
        const auto json = read_json(summary());
        const auto name = json.find("scene");
        return name != json.end() && name->is_string() ? name->get<std::string>() : "";
    }
    try {
        return TraceReader(trace()).run().scene_name;
    } catch (const UserError&) {
        return "";  // none is there, or it was killed before it was one
    }
}

OutputFolder::~OutputFolder() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFolder::claim() {
    open();
    forget_before();
    for (const fs::path& old : {checkpoint(), unfinished(checkpoint()), summary(), trace(),
                                geometry(), GeometryWriter::xdmf_path(geometry())}) {
        remove(old);
    }
}

void OutputFolder::claim_to_go_on(const std::vector<fs::path>& outputs) {
    open();
    remove(unfinished(checkpoint()));
    remove(summary());
    for (const fs::path& file : {trace(), geometry()}) {
        std::ranges::find(outputs, file) == outputs.end() ? bring_back(file) : set_aside(file);
    }
}

void OutputFolder::open() {
    std::error_code error;
    fs::create_directories(path_, error);
    if (error) refuse(path_, "the folder cannot be made: " + error.message());
    lock();
}

void OutputFolder::remove(const fs::path& old) const {
    std::error_code error;
    fs::remove(old, error);
    if (error) refuse(path_, "'" + old.string() + "' cannot be replaced: " + error.message());
}

void OutputFolder::rename(const fs::path& from, const fs::path& to) const {
    std::error_code error;
    fs::rename(from, to, error);
    if (error) refuse(path_, "'" + from.string() + "' cannot be renamed: " + error.message());
}

/// One that is aside already counts: then an earlier resumption was killed while it took it over.
void OutputFolder::set_aside(const fs::path& file) const {
    if (fs::exists(before(file))) {
        remove(file);
    } else if (fs::exists(file)) {
        rename(file, before(file));
    }
}

void OutputFolder::bring_back(const fs::path& file) const {
    if (fs::exists(before(file))) rename(before(file), file);
}

void OutputFolder::forget_before() {
    remove(before(trace()));
    remove(before(geometry()));
}

fs::path OutputFolder::before(const fs::path& file) { return file.string() + ".before"; }

/// The lock is on the folder itself, so that it leaves nothing behind, however the run ends.
void OutputFolder::lock() {
    descriptor_ = ::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor_ < 0) refuse(path_, std::string("cannot be opened: ") + std::strerror(errno));
    if (!try_lock(descriptor_)) refuse_as_busy(path_);
}

}  // namespace weft
