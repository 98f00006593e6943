#include "apps/weft/batch/drive.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <iostream>

#include "apps/weft/batch/child_run.h"
#include "apps/weft/batch/deadline.h"
#include "apps/weft/batch/engine.h"
#include "apps/weft/batch/verdict.h"
#include "runtime/cores.h"
#include "runtime/error.h"
#include "simulation/output/any_checkpoint.h"
#include "simulation/scene/read_scene.h"

namespace weft::batch {

namespace {

namespace fs = std::filesystem;

double seconds_since_1970() {
    using namespace std::chrono;
    return duration<double>(system_clock::now().time_since_epoch()).count();
}

std::string host_name() {
    char name[256] = "";
    ::gethostname(name, sizeof name - 1);
    return name;
}

bool is_checkpoint(const fs::path& file) {
    if (!fs::exists(file)) return false;
    try {
        static_cast<void>(read_any_checkpoint(file));
    } catch (const UserError&) {
        return false;
    }
    return true;
}

class Driver {
public:
    Driver(const fs::path& folder, const Manifest& manifest, const DriveOptions& options,
           const Program& program)
        : folder_(folder),
          manifest_(manifest),
          options_(options),
          program_(program),
          deadline_(manifest.time_limit) {}

    std::vector<Outcome> drive(const std::vector<std::size_t>& indices) {
        std::vector<Outcome> outcomes;
        for (const std::size_t index : indices) {
            outcomes.push_back(one(manifest_.runs.at(index)));
            say(outcomes.back(), outcomes.size(), indices.size());
        }
        return outcomes;
    }

private:
    Outcome one(const Run& run) {
        if (notice_.signal() != 0) return {run.index, kGoesOn, "not begun: asked to stop"};
        if (deadline_.is_over()) return {run.index, kGoesOn, "not begun: the time limit"};
        const RunFolder files(run_path(folder_, run));
        FolderLock lock;
        if (!lock.take(files.path())) {
            return {run.index, kGoesOn, "another process is at it: " + files.path().string()};
        }
        // With the lock in our hands, "running" means that whoever said so was killed.
        Status status = files.status_under_lock();
        if (status.state == State::kFinished) return {run.index, 0, "", status.warnings.size()};
        if (status.state == State::kFailed && !options_.again) {
            return {run.index, status.exit_code.value_or(kFailed),
                    fmt::format("{} (before; --again {})", status.why,
                                status.signal != 0 ? "goes on from its checkpoint, if it has one"
                                                   : "starts it anew")};
        }
        try {
            check_scene(run);
        } catch (const UserError& error) {
            return {run.index, kWrongRequest, error.what()};
        }
        return attempt(run, files, std::move(status));
    }

    /// The scene is not kept in the sweep's folder: it must be what it was.
    void check_scene(const Run& run) {
        if (run.scene.empty()) return;
        const std::string path = scene_path(folder_, run).string();
        std::vector<Override> overrides;
        for (std::size_t i = 0; i + 1 < run.arguments.size(); ++i) {
            if (run.arguments[i] != "--set") continue;
            overrides.push_back({run.arguments[i + 1], "--set " + run.arguments[i + 1]});
        }
        if (hashes_.of(read_scene(path, overrides)) == run.scene_hash) return;
        throw UserError(path +
                        ": the scene, or a mesh of it, has changed since the sweep was made; "
                        "'weft batch SWEEP.toml' takes the new one in, as new runs");
    }

    /// What killed a run, such as a lack of memory, need not be there again. A run that ended with
    /// an error of its own would only meet it again.
    static bool can_go_on(const Status& status, const RunFolder& files) {
        return status.signal != 0 && is_checkpoint(files.checkpoint());
    }

    Outcome attempt(const Run& run, const RunFolder& files, Status status) {
        const bool anew = status.state == State::kFailed && !can_go_on(status, files);
        begin(status);
        files.write(status);
        // Whoever was at it may have been killed between the run's end and the note of it.
        if (!anew && files.has_finished_summary()) {
            return end(run, files, status, {State::kFinished, 0, ""});
        }
        const LastWords words(files.log());
        ChildRun child(files.log(), [&] { return in_child(run, files, anew); });
        const ChildEnd ended = child.wait(notice_, [&] { return deadline_.seconds_left(); });
        status.signal = ended.signal;
        return end(run, files, status, verdict_of(ended, words));
    }

    void begin(Status& status) const {
        const Engine engine = this_engine();
        status.state = State::kRunning;
        status.exit_code.reset();
        status.why.clear();
        status.signal = 0;
        status.warnings.clear();
        ++status.attempts;
        status.host = host_name();
        status.cores = static_cast<int>(usable_cores().size());
        status.engine = engine.name;
        status.job = engine.job;
        status.weft = options_.weft;
        status.start = seconds_since_1970();
        status.end = 0.0;
    }

    int in_child(const Run& run, const RunFolder& files, bool anew) const {
        // Side by side, runs measure other times than alone: these stay in the sweep.
        ::setenv("WEFT_COSTS", fs::absolute(folder_ / "costs.json").c_str(), /*overwrite=*/0);
        std::vector<std::string> list{manifest_.command};
        if (!run.scene.empty()) list.push_back(scene_path(folder_, run).string());
        list.insert(list.end(), run.arguments.begin(), run.arguments.end());
        list.insert(list.end(), {"--out", files.path().string()});
        if (manifest_.command == "run") list.push_back(anew ? "--force" : "--resume");
        return program_(list);
    }

    /// Notes what has become of it.
    Outcome end(const Run& run, const RunFolder& files, Status& status, const Verdict& verdict) {
        status.end = seconds_since_1970();
        status.wall += status.end - status.start;
        status.state = verdict.state;
        status.exit_code = verdict.exit_code;
        status.why = verdict.why;
        status.warnings = files.warnings();
        files.write(status);
        return {run.index, verdict.exit_code, verdict.why, status.warnings.size()};
    }

    void say(const Outcome& outcome, std::size_t done, std::size_t count) const {
        if (options_.quiet && outcome.exit_code == 0) return;
        const Run& run = manifest_.runs[outcome.index];
        std::string text = outcome.exit_code == 0 ? "finished" : outcome.why;
        if (outcome.warnings > 0) text += fmt::format("; warnings: {}", outcome.warnings);
        std::cerr << fmt::format("weft: {}: run {} ({}): {} [{}/{}]\n", manifest_.name, run.index,
                                 run.id, text, done, count)
                  << std::flush;
    }

    const fs::path& folder_;
    const Manifest& manifest_;
    const DriveOptions& options_;
    const Program& program_;
    StopNotice notice_;
    Deadline deadline_;
    SceneHashes hashes_;
};

}  // namespace

fs::path run_path(const fs::path& folder, const Run& run) { return folder / "runs" / run.id; }

fs::path scene_path(const fs::path& folder, const Run& run) {
    return (folder / run.scene).lexically_normal();
}

std::vector<Outcome> drive(const fs::path& folder, const Manifest& manifest,
                           const std::vector<std::size_t>& indices, const DriveOptions& options,
                           const Program& program) {
    return Driver(folder, manifest, options, program).drive(indices);
}

}  // namespace weft::batch
