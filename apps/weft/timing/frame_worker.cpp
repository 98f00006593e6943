#include "apps/weft/timing/frame_worker.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <sstream>

#include "runtime/error.h"
#include "runtime/io/system_call.h"
#include "simulation/diagnostics.h"
#include "simulation/simulation.h"

namespace weft {

namespace {

constexpr char kReady = 'r';
constexpr char kFrame = 'f';
constexpr char kState = 's';
constexpr char kEnd = 'e';

// An answer is one line: what happened, then its text.
constexpr char kDone = '+';
constexpr char kUserError = 'u';
constexpr char kRunError = '!';

void write_line(int descriptor, char status, std::string text) {
    for (char& c : text) {
        if (c == '\n') c = ' ';
    }
    const std::string line = status + text + '\n';
    std::size_t sent = 0;
    while (sent < line.size()) {
        const ssize_t count = ::write(descriptor, line.data() + sent, line.size() - sent);
        if (count <= 0) ::_exit(1);  // whoever asked is gone
        sent += static_cast<std::size_t>(count);
    }
}

std::string read_line(int descriptor) {
    std::string line;
    char c = 0;
    while (::read(descriptor, &c, 1) == 1 && c != '\n') line += c;
    return line;
}

std::string frame_line(Simulation& simulation) {
    const FrameRecord frame = simulation.advance({.tasks = false});
    const auto& devices = simulation.devices();
    double busy = 0.0;  // of those that could have been
    int taking_part = 0;
    for (std::size_t d = 0; d < devices.size(); ++d) {
        const auto team = std::ranges::count_if(devices, [&](const auto& other) {
            return other->info().team == devices[d]->info().team;
        });
        busy += frame.busy[d] / static_cast<double>(team);
        taking_part += frame.busy[d] > 0.0 ? 1 : 0;
    }
    return fmt::format("{} {} {} {} {} {}", 1e3 * frame.wall_time(), 1e3 * frame.planned_makespan,
                       1e3 * frame.measured_makespan, 1e3 * frame.plan_time,
                       busy / frame.measured_makespan, taking_part > 1 ? 1 : 0);
}

std::string end_line(const Simulation& simulation) {
    return fmt::format("{} {}", simulation.hash(), simulation.energies().total());
}

}  // namespace

FrameWorker::FrameWorker(const RunOptions& options) : devices_(options.device) {
    int commands[2];
    int answers[2];
    if (::pipe(commands) != 0 || ::pipe(answers) != 0) throw RunError("cannot make a pipe");
    std::fflush(nullptr);
    process_ = ::fork();
    if (process_ < 0) throw RunError("cannot start a process");
    if (process_ == 0) {
        ::close(commands[1]);
        ::close(answers[0]);
        serve(options, commands[0], answers[1]);
    }
    ::close(commands[0]);
    ::close(answers[1]);
    to_worker_ = commands[1];
    from_worker_ = answers[0];
}

FrameWorker::~FrameWorker() {
    // Not by closing the pipe alone: workers started later hold copies of its end. One that has
    // ended already does not read, and need not.
    [[maybe_unused]] const ssize_t sent = ::write(to_worker_, &kEnd, 1);
    ::close(to_worker_);
    ::close(from_worker_);
    until_uninterrupted([&] { return ::waitpid(process_, nullptr, 0); });
}

void FrameWorker::serve(const RunOptions& options, int in, int out) {
    try {
        const Scene scene = read_scene(options.scene, options.overrides());
        Warnings warnings;
        SimulationOptions settings = options.simulation();
        settings.on_trouble = OnTrouble::kReport;  // times are what is asked for
        Simulation simulation(scene, settings, warnings);
        char command = 0;
        while (::read(in, &command, 1) == 1 && command != kEnd) {
            if (command == kFrame)
                write_line(out, kDone, frame_line(simulation));
            else
                write_line(out, kDone, command == kState ? end_line(simulation) : "");
        }
    } catch (const UserError& error) {
        write_line(out, kUserError, error.what());
    } catch (const std::exception& error) {
        write_line(out, kRunError, error.what());
    }
    ::_exit(0);
}

std::string FrameWorker::ask(char command) {
    // A worker that has failed has said so already, and does not listen any more.
    const ssize_t sent = ::write(to_worker_, &command, 1);
    const std::string answer = read_line(from_worker_);
    if (sent != 1 && answer.empty()) throw RunError(devices_ + ": the worker process has ended");
    if (answer.empty()) throw RunError(devices_ + ": the worker process was killed");
    const std::string text = answer.substr(1);
    if (answer[0] == kUserError) throw UserError(text);
    if (answer[0] == kRunError) throw RunError(devices_ + ": " + text);
    return text;
}

void FrameWorker::wait_until_ready() { ask(kReady); }
EndState FrameWorker::end_state() {
    std::istringstream in(ask(kState));
    EndState state;
    in >> state.hash >> state.energy;
    return state;
}

FrameSample FrameWorker::advance() {
    std::istringstream in(ask(kFrame));
    FrameSample s;
    in >> s.wall >> s.planned >> s.measured >> s.plan >> s.utilisation >> s.mixed;
    return s;
}

}  // namespace weft
