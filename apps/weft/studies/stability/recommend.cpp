#include "apps/weft/studies/stability/recommend.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <nlohmann/json.hpp>

#include "apps/weft/output/csv_text.h"
#include "apps/weft/output/progress.h"
#include "runtime/error.h"

namespace weft::stability {

namespace {

constexpr int kSubsteps[] = {1, 2, 4, 8, 16, 32, 64, 128};
constexpr int kIterations[] = {1, 2, 4, 8, 16, 32};
constexpr double kLittleStrain = 0.01;

class Trials {
public:
    Trials(const RunOptions& options, double seconds)
        : options_(options), seconds_(seconds), start_(Clock::now()) {}

    bool is_time_left() const {
        return std::chrono::duration<double>(Clock::now() - start_).count() < seconds_;
    }

    Trial run(const std::string& solver, int substeps, int iterations) const {
        Trial trial{solver, substeps, iterations, true, 0.0, 0.0, ""};
        try {
            advance_all(trial);
        } catch (const RunError& error) {
            fail(trial, error.what());
        }
        return trial;
    }

private:
    using Clock = std::chrono::steady_clock;

    static void fail(Trial& trial, const std::string& why) {
        if (trial.holds) trial.why = why;
        trial.holds = false;
    }

    void advance_all(Trial& trial) const {
        RunOptions own = options_;
        own.solver = trial.solver;
        own.substeps = std::to_string(trial.substeps);
        own.iterations = std::to_string(trial.iterations);
        const Scene scene = read_scene(own.scene, own.overrides());
        SimulationOptions settings = own.simulation();
        settings.on_trouble = OnTrouble::kReport;
        Warnings warnings;
        Simulation simulation(scene, settings, warnings);
        for (const std::string& warning : warnings) {
            if (warning.find("too fine for scene.substeps") != std::string::npos)
                fail(trial, "too few steps for so fine a mesh");
            if (warning.find("is stretched between where it is held") != std::string::npos)
                fail(trial, "too few steps for what is stretched between pins");
        }
        std::vector<double> times;
        while (simulation.frame() < scene.frames && trial.holds && is_time_left()) {
            const FrameRecord frame = simulation.advance({.tasks = false});
            times.push_back(frame.wall_time());
            trial.strain_rms = std::max(trial.strain_rms, frame.strain_rms);
            if (simulation.troubles().empty()) continue;
            const Trouble& first = simulation.troubles().front();
            fail(trial, fmt::format("frame {}: {}", first.frame, first.what));
        }
        if (simulation.frame() < scene.frames) fail(trial, "no time was left (--time)");
        if (times.empty()) return;
        std::ranges::nth_element(times, times.begin() + static_cast<long>(times.size() / 2));
        trial.ms_per_frame = 1e3 * times[times.size() / 2];
    }

    const RunOptions& options_;
    double seconds_;
    Clock::time_point start_;
};

double cost_of(const Trial& trial) { return trial.ms_per_frame; }

/// The least strain that any trial found, and a little more.
double strain_wanted(const std::vector<Trial>& trials) {
    double least = std::numeric_limits<double>::infinity();
    for (const Trial& t : trials) {
        if (t.holds) least = std::min(least, t.strain_rms);
    }
    return std::max(1.5 * least, least + kLittleStrain);
}

void choose(Advice& advice) {
    advice.strain_wanted = strain_wanted(advice.trials);
    for (Trial& trial : advice.trials) {
        if (!trial.holds) continue;
        if (trial.strain_rms > advice.strain_wanted) {
            trial.holds = false;
            trial.why = fmt::format("edges are strained by {:.2g} % RMS, where {:.2g} % would do",
                                    100.0 * trial.strain_rms, 100.0 * advice.strain_wanted);
        } else if (!advice.cheapest || cost_of(trial) < cost_of(*advice.cheapest)) {
            advice.cheapest = trial;
        }
    }
}

nlohmann::ordered_json json_of(const Trial& trial) {
    return {{"solver", trial.solver},
            {"substeps", trial.substeps},
            {"iterations", trial.iterations},
            {"holds", trial.holds},
            {"strain_rms", trial.strain_rms},
            {"ms_per_frame", trial.ms_per_frame},
            {"why", trial.why}};
}

/// Strain and time; dashes where no frame was done.
std::string measured_text(const Trial& t) {
    if (t.ms_per_frame == 0.0) return fmt::format("{:>10} {:>10} ", "-", "-");
    return fmt::format("{:>8.2f} % {:>10.2f} ", 100.0 * t.strain_rms, t.ms_per_frame);
}

}  // namespace

Advice advise(const RunOptions& options, const std::vector<std::string>& solvers, double seconds) {
    const Trials trials(options, seconds);
    std::vector<Trial> tried;
    const int pairs = static_cast<int>(solvers.size() * std::size(kIterations));
    Progress progress("pair", pairs, options.quiet);
    int done = 0;
    for (const int iterations : kIterations) {
        for (const std::string& solver : solvers) {
            // One step beyond the first that raises no alarm: that may be strained too much.
            int holding = 0;
            for (const int substeps : kSubsteps) {
                if (holding > 1 || !trials.is_time_left()) break;
                const Trial trial = trials.run(solver, substeps, iterations);
                holding += trial.holds ? 1 : 0;
                tried.push_back(trial);
            }
            progress.show(++done);
        }
    }
    return advice_of(std::move(tried), read_scene(options.scene, options.overrides()).frames);
}

Advice advice_of(std::vector<Trial> trials, int frames) {
    Advice advice;
    advice.trials = std::move(trials);
    advice.frames = frames;
    choose(advice);
    return advice;
}

std::string to_csv(const Advice& advice) {
    std::string text = "solver,substeps,iterations,holds,strain_rms,ms_per_frame,why\n";
    for (const Trial& t : advice.trials) {
        text += fmt::format("{},{},{},{},{:.6g},{:.6g},{}\n", t.solver, t.substeps, t.iterations,
                            t.holds ? "yes" : "no", t.strain_rms, t.ms_per_frame, csv_cell(t.why));
    }
    return text;
}

std::string to_text(const Advice& advice) {
    std::string text = fmt::format("{:<8} {:>9} {:>11} {:>10} {:>10}  {}\n", "solver", "substeps",
                                   "iterations", "strain", "ms/frame", "");
    for (const Trial& t : advice.trials) {
        text += fmt::format("{:<8} {:>9} {:>11} {} {}\n", t.solver, t.substeps, t.iterations,
                            measured_text(t), t.holds ? "holds" : t.why);
    }
    if (!advice.cheapest) return text + "\nnothing that was tried holds; give it more --time\n";
    const Trial& best = *advice.cheapest;
    return text + fmt::format(
                      "\nthe cheapest that holds, {} frames each: --solver {} --substeps "
                      "{} --iterations {} ({:.2f} ms per frame)\n",
                      advice.frames, best.solver, best.substeps, best.iterations,
                      best.ms_per_frame);
}

nlohmann::ordered_json to_json(const Advice& advice) {
    nlohmann::ordered_json json;
    json["frames"] = advice.frames;
    json["strain_wanted"] = advice.strain_wanted;
    json["recommended"] = advice.cheapest ? json_of(*advice.cheapest) : nlohmann::ordered_json();
    json["trials"] = nlohmann::ordered_json::array();
    for (const Trial& trial : advice.trials) json["trials"].push_back(json_of(trial));
    return json;
}

}  // namespace weft::stability
