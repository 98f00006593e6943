#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace weft::batch {

/// What has become of a run.
enum class State {
    kWaiting,   ///< nobody has begun it
    kRunning,   ///< somebody holds its folder's lock
    kLost,      ///< says that it runs, but nobody holds the lock: it was killed
    kStopped,   ///< in good order; goes on where it stopped
    kFailed,    ///< the run itself cannot be done
    kFinished,  ///< all frames
};

std::string name_of(State state);
/// All six, in this order.
const std::vector<State>& all_states();
/// "waiting,stopped". Throws UserError that names `option`.
std::vector<State> parse_states(const std::string& text, const std::string& option);

/// status.json of a run. Written only by whoever holds the lock.
struct Status {
    State state = State::kWaiting;
    std::optional<int> exit_code;  ///< of the attempt that ended last, as --index gives it
    std::string why;               ///< it stopped or failed
    int attempts = 0;
    std::string host;
    int cores = 0;       ///< that the process might use
    std::string engine;  ///< "slurm", ...; empty: none that is known
    std::string job;     ///< the engine's name for it
    std::string weft;    ///< version
    double start = 0.0;  ///< of the last attempt [s since 1970]
    double end = 0.0;    ///< 0: goes on
    double wall = 0.0;   ///< all attempts that have ended [s]
    int signal = 0;      ///< that killed the run itself in that attempt; 0: it ended by itself
    std::vector<std::string> warnings{};  ///< as summary.json has them at the end of an attempt
};

/// The folder of one run: a normal output folder, with status.json, log.txt and the lock.
class RunFolder {
public:
    explicit RunFolder(std::filesystem::path path) : path_(std::move(path)) {}

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path log() const { return path_ / "log.txt"; }
    std::filesystem::path summary() const { return path_ / "summary.json"; }
    std::filesystem::path trace() const { return path_ / "trace.h5"; }
    std::filesystem::path checkpoint() const { return path_ / "checkpoint"; }

    /// What status.json says, with `state` as the lock shows it. Throws RunError where it cannot be
    /// read.
    Status status() const;
    /// The same for whoever holds the lock: "running" was said by somebody who was killed.
    Status status_under_lock() const;
    /// As a whole or not at all. Throws RunError.
    void write(const Status& status) const;
    /// What the run has left; an empty object where it is missing, or damaged.
    nlohmann::ordered_json read_summary() const;
    /// Whether a run in it has come to its end.
    bool has_finished_summary() const;
    /// Of its summary.
    std::vector<std::string> warnings() const;

private:
    std::filesystem::path path_;
};

/// A lock on a file in a folder, held until the last process that inherited it has ended, however
/// it ends.
class FolderLock {
public:
    FolderLock() = default;
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

    /// False if somebody else holds it for longer than a look takes. Makes the folder. Throws
    /// UserError where that cannot be, RunError where the file system has no locks.
    bool take(const std::filesystem::path& folder);

    /// Looks, for an instant.
    static bool is_held(const std::filesystem::path& folder);

private:
    int descriptor_ = -1;
};

}  // namespace weft::batch
