#include "apps/weft/batch/run_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <thread>

#include "runtime/error.h"
#include "runtime/io/json_text.h"
#include "runtime/io/whole_file.h"
#include "runtime/near_miss.h"

namespace weft::batch {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Whoever only looks holds the lock for microseconds.
constexpr int kTries = 5;
constexpr std::chrono::milliseconds kPause{10};

const std::vector<std::string>& state_names() {
    static const std::vector<std::string> names{"waiting", "running", "lost",
                                                "stopped", "failed",  "finished"};
    return names;
}

State state_named(const std::string& name, const std::string& where) {
    const auto at = std::ranges::find(state_names(), name);
    if (at != state_names().end()) return all_states()[std::size_t(at - state_names().begin())];
    throw UserError(fmt::format("{}: unknown state '{}'; {}", where, name,
                                near_miss_or_list(name, state_names())));
}

fs::path status_path(const fs::path& folder) { return folder / "status.json"; }
fs::path lock_path(const fs::path& folder) { return folder / "lock"; }

Json to_json(const Status& status) {
    Json json = Json::object();
    json["state"] = name_of(status.state);
    json["exit_code"] = status.exit_code ? Json(*status.exit_code) : Json(nullptr);
    if (!status.why.empty()) json["why"] = status.why;
    if (status.signal != 0) json["signal"] = status.signal;
    json["attempts"] = status.attempts;
    json["host"] = status.host;
    json["cores"] = status.cores;
    if (!status.engine.empty()) json["engine"] = status.engine;
    if (!status.job.empty()) json["job"] = status.job;
    json["weft"] = status.weft;
    json["start"] = status.start;
    json["end"] = status.end > 0.0 ? Json(status.end) : Json(nullptr);
    json["wall_s"] = status.wall;
    if (!status.warnings.empty()) json["warnings"] = status.warnings;
    return json;
}

Status from_json(const Json& json, const std::string& path) {
    Status status;
    status.state = state_named(json.at("state"), path);
    if (!json.at("exit_code").is_null()) status.exit_code = json["exit_code"].get<int>();
    status.why = json.value("why", "");
    status.signal = json.value("signal", 0);
    status.attempts = json.at("attempts");
    status.host = json.at("host");
    status.cores = json.at("cores");
    status.engine = json.value("engine", "");
    status.job = json.value("job", "");
    status.weft = json.at("weft");
    status.start = json.at("start");
    status.end = json.at("end").is_null() ? 0.0 : json["end"].get<double>();
    status.wall = json.at("wall_s");
    status.warnings = json.value("warnings", std::vector<std::string>{});
    return status;
}

Status read_status(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) return {};
    try {
        return from_json(Json::parse(file), path.string());
    } catch (const std::exception& error) {
        throw RunError(fmt::format("{}: cannot be read: {}", path.string(), error.what()));
    }
}

bool try_lock(int descriptor, const fs::path& folder) {
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return true;
    if (errno == EWOULDBLOCK) return false;
    throw RunError(fmt::format(
        "{}: this file system has no locks ({}), and without them two processes might do the same "
        "run; choose another --out",
        folder.string(), std::strerror(errno)));
}

}  // namespace

const std::vector<State>& all_states() {
    static const std::vector<State> states{State::kWaiting, State::kRunning, State::kLost,
                                           State::kStopped, State::kFailed,  State::kFinished};
    return states;
}

std::string name_of(State state) { return state_names()[static_cast<std::size_t>(state)]; }

std::vector<State> parse_states(const std::string& text, const std::string& option) {
    std::vector<State> states;
    std::size_t begin = 0;
    while (begin <= text.size()) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        states.push_back(state_named(text.substr(begin, end - begin), option));
        begin = end + 1;
    }
    return states;
}

Status RunFolder::status() const {
    // In this order: whoever ends writes first, and lets go of the lock then.
    const bool held = FolderLock::is_held(path_);
    Status status = status_under_lock();
    if (held) status.state = State::kRunning;
    return status;
}

Status RunFolder::status_under_lock() const {
    Status status = read_status(status_path(path_));
    if (status.state == State::kRunning) status.state = State::kLost;
    return status;
}

void RunFolder::write(const Status& status) const {
    write_whole_file(status_path(path_), json_text(to_json(status)) + '\n');
}

Json RunFolder::read_summary() const {
    std::ifstream file(summary(), std::ios::binary);
    if (!file) return Json::object();
    Json json = Json::parse(file, nullptr, /*allow_exceptions=*/false);
    return json.is_object() ? json : Json::object();
}

bool RunFolder::has_finished_summary() const { return read_summary().value("finished", false); }

std::vector<std::string> RunFolder::warnings() const {
    return read_summary().value("warnings", std::vector<std::string>{});
}

FolderLock::~FolderLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

bool FolderLock::take(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw UserError(folder.string() + ": cannot be made: " + error.message());
    descriptor_ = ::open(lock_path(folder).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0) {
        throw UserError(folder.string() + ": cannot be written: " + std::strerror(errno));
    }
    for (int i = 0; i < kTries; ++i) {
        if (try_lock(descriptor_, folder)) return true;
        std::this_thread::sleep_for(kPause);
    }
    ::close(descriptor_);
    descriptor_ = -1;
    return false;
}

bool FolderLock::is_held(const fs::path& folder) {
    const int descriptor = ::open(lock_path(folder).c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return false;
    const bool held = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    ::close(descriptor);
    return held;
}

}  // namespace weft::batch
