#include "apps/weft/timing/frame_worker.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "apps/weft/output/warnings.h"
#include "apps/weft/process/answer.h"
#include "runtime/error.h"
#include "runtime/io/json_text.h"
#include "runtime/io/system_call.h"
#include "simulation/simulation.h"
#include "simulation/solver/async_iterates.h"
#include "simulation/state/diagnostics.h"

namespace weft {

namespace {

constexpr char kReady = 'r';
constexpr char kFrame = 'f';
constexpr char kState = 's';
constexpr char kEnd = 'e';

/// An answer is one line.
void write_line(int descriptor, std::string answer) {
    std::ranges::replace(answer, '\n', ' ');
    if (!write_all(descriptor, answer + '\n')) ::_exit(1);  // whoever asked is gone
}

bool read_char(int descriptor, char& c) {
    return until_uninterrupted([&] { return ::read(descriptor, &c, 1); }) == 1;
}

std::string read_line(int descriptor) {
    std::string line;
    char c = 0;
    while (read_char(descriptor, c) && c != '\n') line += c;
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

/// A simulation, and what was wrong with its scene.
struct Served {
    std::optional<Simulation> simulation;
    Warnings warnings;
};

/// Whatever --plan says: one device has nobody to tell.
bool is_asynchronous(const Simulation& simulation) {
    return dynamic_cast<const AsyncIterates*>(&simulation.solver()) != nullptr;
}

std::string end_line(const Served& served) {
    Warnings warnings = served.warnings;
    const Simulation& simulation = *served.simulation;
    for (const LostDevice& lost : simulation.losses()) {
        warnings.push_back(text_of(lost, simulation));
    }
    for (const Trouble& trouble : simulation.troubles()) warnings.push_back(text_of(trouble));
    const nlohmann::json end{{"hash", simulation.hash()},
                             {"is_async", is_asynchronous(simulation)},
                             {"energy", simulation.energies().total()},
                             {"warnings", warnings}};
    return json_text(end, -1);
}

std::string reply(char command, Served& served) {
    if (command == kFrame) return frame_line(*served.simulation);
    return command == kState ? end_line(served) : "";
}

void set_up(Served& served, const RunOptions& options) {
    const Scene scene = read_scene(options.scene, options.overrides());
    SimulationOptions settings = options.simulation();
    settings.on_trouble = OnTrouble::kReport;  // times are what is asked for
    served.simulation.emplace(scene, settings, served.warnings);
}

}  // namespace

FrameWorker::FrameWorker(const RunOptions& options) : devices_(options.device) {
    if (!commands_.is_open() || !answers_.is_open()) throw RunError("cannot make a pipe");
    process_ = start_process([&] {
        commands_.close_writer();
        answers_.close_reader();
        serve(options);
        return 0;
    });
    if (process_ < 0) throw RunError("cannot start a process");
    commands_.close_reader();
    answers_.close_writer();
}

FrameWorker::~FrameWorker() {
    // Not by closing the pipe alone: workers started later hold copies of its end. One that has
    // ended already does not read, and need not.
    write_all(commands_.writer(), {&kEnd, 1});
    commands_.close_writer();
    answers_.close_reader();
    wait_for_process(process_);
}

/// A failure is the answer to all that is asked from then on.
void FrameWorker::serve(const RunOptions& options) {
    Served served;
    std::string answer = answer_of([&] {
        set_up(served, options);
        return "";
    });
    char command = 0;
    while (read_char(commands_.reader(), command) && command != kEnd) {
        if (!is_failure(answer)) answer = answer_of([&] { return reply(command, served); });
        write_line(answers_.writer(), answer);
    }
}

std::string FrameWorker::ask(char command) {
    const bool is_sent = write_all(commands_.writer(), {&command, 1});
    const std::string answer = read_line(answers_.reader());
    if (!is_sent && answer.empty()) throw RunError(devices_ + ": the worker process has ended");
    if (answer.empty()) throw RunError(devices_ + ": the worker process was killed");
    return result_of(answer, devices_);
}

void FrameWorker::wait_until_ready() { ask(kReady); }
EndState FrameWorker::end_state() {
    const auto state = nlohmann::json::parse(ask(kState));
    return {state["hash"], state["is_async"], state["energy"], state["warnings"]};
}

FrameSample FrameWorker::advance() {
    std::istringstream in(ask(kFrame));
    FrameSample s;
    in >> s.wall >> s.planned >> s.measured >> s.plan >> s.utilisation >> s.mixed;
    return s;
}

}  // namespace weft
