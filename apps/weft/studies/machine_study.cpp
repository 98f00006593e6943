#include "apps/weft/studies/machine_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/weft/output/progress.h"
#include "apps/weft/trace/recorded_frames.h"
#include "apps/weft/trace/recorded_scene.h"
#include "runtime/error.h"
#include "runtime/trace/recorded_graph.h"
#include "simulation/choice/async_loss.h"
#include "simulation/choice/machine_forecast.h"
#include "simulation/simulation.h"
#include "simulation/solver/async_iterates.h"

namespace weft {

namespace {

constexpr std::array kWindows{2, 3, 5};

/// Of one device, by the solver's kinds.
struct MeasuredDevice {
    std::string name;
    std::vector<scheduler::LinearCost> costs;
};

/// The first device of the frame that has done all kinds of tasks. A run by an asynchronous plan
/// has more kinds than its solver, behind these.
MeasuredDevice measured_device(const std::string& trace, const RunDescription& run,
                               const FrameRecord& frame, const std::vector<std::string>& kinds) {
    if (run.kinds.size() < kinds.size() ||
        !std::equal(kinds.begin(), kinds.end(), run.kinds.begin())) {
        throw UserError(trace +
                        ": the solver has other kinds of tasks here; the trace may be of another "
                        "version of weft");
    }
    const MachineCosts costs = recorded_costs(run, frame);
    for (std::size_t d = 0; d < costs.devices.size(); ++d) {
        MeasuredDevice device{costs.devices[d], {}};
        double sum = 0.0;
        for (std::size_t k = 0; k < kinds.size() && costs.kinds[k][d]; ++k) {
            device.costs.push_back(*costs.kinds[k][d]);
            sum += device.costs.back().per_item + device.costs.back().fixed;
        }
        if (device.costs.size() == kinds.size() && sum > 0.0) return device;
    }
    throw UserError(trace + ": no device of the frame has costs for all kinds of tasks");
}

AsyncSettings with_window(int window) {
    AsyncSettings settings;
    settings.window = window;
    return settings;
}

/// Everything that machines with so many devices are planned with.
class Machines {
public:
    Machines(Model& model, Solver& solver, int devices) {
        std::vector<Solver*> list;
        for (const int window : kWindows) {
            asyncs_.push_back(std::make_unique<AsyncIterates>(model, make_solver(model), devices,
                                                              with_window(window)));
            list.push_back(asyncs_.back().get());
        }
        forecaster_ = std::make_unique<Forecaster>(solver, list, model.strips.count(), devices);
    }

    Forecast forecast(const TimingModel& timing) { return forecaster_->forecast(timing); }

private:
    std::vector<std::unique_ptr<AsyncIterates>> asyncs_;
    std::unique_ptr<Forecaster> forecaster_;
};

class MachinePlanner {
public:
    MachinePlanner(const std::string& trace, std::optional<std::uint32_t> frame, bool quiet)
        : reader_(trace),
          frame_(reader_.frame(find_frame(reader_, trace, frame))),
          model_(scene_of(reader_.run()), warnings_),
          solver_(make_solver(model_)),
          device_(measured_device(trace, reader_.run(), frame_, solver_->kinds())),
          heaviest_(heaviest_kind()),
          quiet_(quiet) {}

    MachineStudy study(const MachineGrid& grid) {
        MachineStudy study{model_.scene.name,
                           frame_.frame,
                           device_.name,
                           solver_->kinds()[heaviest_],
                           model_.vertex_count(),
                           model_.strips.count(),
                           model_.scene.solver.iterations,
                           {}};
        AsyncLoss loss = make_loss();
        const int count = static_cast<int>(grid.devices.size() * kFasterAt.size());
        Progress progress("map", count, quiet_);
        int done = 0;
        for (const int devices : grid.devices) {
            Machines machines(model_, *solver_, devices);
            for (const FasterAt faster : kFasterAt) {
                for (const double ratio : grid.ratios) {
                    for (const double wait : grid.waits) {
                        MachineRow row{faster, devices, ratio, wait, {}, 0, 1.0};
                        fill(row, machines, loss);
                        study.rows.push_back(row);
                    }
                }
                progress.show(++done);
            }
        }
        return study;
    }

private:
    static Scene scene_of(const RunDescription& run) { return recorded_scene(run, std::nullopt); }

    std::size_t heaviest_kind() const {
        const Step step = solver_->make_step(Partition::whole(model_.strips.count()));
        std::vector<double> sums(device_.costs.size(), 0.0);
        for (const Task& task : step.tasks()) {
            const auto kind = static_cast<std::size_t>(task.body->kind);
            sums[kind] += device_.costs[kind](static_cast<double>(task.items));
        }
        return static_cast<std::size_t>(std::ranges::max_element(sums) - sums.begin());
    }

    /// The frame's start is computed anew: traces have no states.
    AsyncLoss make_loss() {
        SimulationOptions options;
        options.devices = "cpu";
        options.plan = PlanKind::kSingle;
        options.calibrate = false;
        options.on_trouble = OnTrouble::kReport;
        options.on_crossing = OnCrossing::kWarn;
        Simulation simulation(model_.scene, options, warnings_);
        Progress progress("frame", static_cast<int>(frame_.frame), quiet_);
        while (simulation.frame() < static_cast<int>(frame_.frame)) {
            simulation.advance({.tasks = false});
            progress.show(simulation.frame());
        }
        return {model_.scene, simulation.frame(), simulation.positions(), simulation.velocities()};
    }

    TimingModel timing_of(const MachineRow& row) const {
        TimingModel timing(device_.costs.size(), static_cast<std::size_t>(row.devices));
        for (int d = 0; d < row.devices; ++d) {
            const bool is_fast = d % 2 == 1;
            for (std::size_t kind = 0; kind < device_.costs.size(); ++kind) {
                const bool is_better =
                    is_fast && (row.faster == FasterAt::kEverything || kind == heaviest_);
                scheduler::CostFit fit{device_.costs[kind], 0.0, 1};
                if (is_better) fit.cost.per_item /= row.ratio;
                timing.costs().restore(static_cast<std::uint32_t>(kind),
                                       static_cast<std::uint32_t>(d), fit);
            }
            for (int other = 0; other < row.devices; ++other) {
                if (other != d) timing.set_latency(d, other, row.wait);
            }
        }
        return timing;
    }

    void fill(MachineRow& row, Machines& machines, AsyncLoss& loss) {
        const Forecast forecast = machines.forecast(timing_of(row));
        row.time = {forecast.single, forecast.exact, forecast.placed, Forecast::kNever};
        for (std::size_t w = 0; w < kWindows.size(); ++w) {
            const auto more = loss.factor(with_window(kWindows[w]), row.devices);
            if (!more) {
                throw UserError(fmt::format(
                    "--machines: at frame {} there is nothing to solve, so nobody can say what an "
                    "asynchronous plan loses; choose another --frame",
                    frame_.frame));
            }
            const double time = forecast.async[w] * *more;
            if (time >= row.time.back()) continue;
            row.time.back() = time;
            row.window = kWindows[w];
            row.more_iterations = *more;
        }
    }

    TraceReader reader_;
    FrameRecord frame_;
    Warnings warnings_;
    Model model_;
    std::unique_ptr<Solver> solver_;
    MeasuredDevice device_;
    std::size_t heaviest_;
    bool quiet_;
};

std::string number(double seconds) {
    return std::isfinite(seconds) ? fmt::format("{}", seconds) : "";
}

/// S, E, P or A for each machine of one map: ratios down, waits across.
std::string letters_of(const MachineStudy& study, FasterAt faster, int devices) {
    std::string text;
    double ratio = -1.0;
    for (const MachineRow& row : study.rows) {
        if (row.faster != faster || row.devices != devices) continue;
        if (row.ratio != ratio) {
            if (ratio >= 0.0) text += '\n';
            ratio = row.ratio;
            text += fmt::format("{:>12g} x ", ratio);
        }
        const char letter = name_of(row.winner())[0];
        text += fmt::format("{:>7}", static_cast<char>(letter - 'a' + 'A'));
    }
    return text + '\n';
}

template <class Value>
std::vector<Value> values_of(const MachineStudy& study, Value MachineRow::*field) {
    std::vector<Value> values;
    for (const MachineRow& row : study.rows) {
        if (std::ranges::find(values, row.*field) == values.end()) values.push_back(row.*field);
    }
    return values;
}

std::string head_of(const MachineStudy& study) {
    std::string text = fmt::format("{:>14}", "wait [us]");
    for (const double wait : values_of(study, &MachineRow::wait)) {
        text += fmt::format("{:>7g}", 1e6 * wait);
    }
    return text + '\n';
}

}  // namespace

std::string name_of(FasterAt faster) {
    return faster == FasterAt::kEverything ? "everything" : "one kind";
}

std::string name_of(Winner winner) {
    static constexpr std::array<const char*, kWinners.size()> kNames{"single", "exact", "placed",
                                                                     "async"};
    return kNames[static_cast<std::size_t>(winner)];
}

Winner MachineRow::winner() const {
    const double best = std::ranges::min(time);
    const auto first =
        std::ranges::find_if(time, [&](double t) { return t <= best * (1.0 + kMargin); });
    return kWinners[static_cast<std::size_t>(first - time.begin())];
}

MachineStudy study_machines(const std::string& trace, std::optional<std::uint32_t> frame,
                            const MachineGrid& grid, bool quiet) {
    return MachinePlanner(trace, frame, quiet).study(grid);
}

std::string to_csv(const MachineStudy& study) {
    std::string csv =
        "faster_at,devices,ratio,wait_s,single_s,exact_s,placed_s,async_s,async_window,"
        "async_more_iterations,winner\n";
    for (const MachineRow& row : study.rows) {
        csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", name_of(row.faster), row.devices,
                           row.ratio, row.wait, number(row.time[0]), number(row.time[1]),
                           number(row.time[2]), number(row.time[3]), row.window,
                           row.more_iterations, name_of(row.winner()));
    }
    return csv;
}

std::string to_text(const MachineStudy& study) {
    std::string text = fmt::format(
        "{}, frame {}: {} vertices in {} strips, {} iterations; costs of {}\n"
        "Least time to the error that these iterations reach: S single, E exact, P placed, A async "
        "(with all the iterations that it needs)\n",
        study.scene, study.frame, study.vertices, study.strips, study.iterations, study.device);
    for (const FasterAt faster : kFasterAt) {
        const std::string what =
            faster == FasterAt::kEverything ? "everything" : '"' + study.fast_kind + '"';
        for (const int devices : values_of(study, &MachineRow::devices)) {
            text += fmt::format("\n{} devices, every second one so many times faster at {}\n",
                                devices, what);
            text += head_of(study) + letters_of(study, faster, devices);
        }
    }
    return text;
}

nlohmann::ordered_json to_json(const MachineStudy& study) {
    nlohmann::ordered_json json{
        {"scene", study.scene},           {"frame", study.frame},
        {"device", study.device},         {"fast_kind", study.fast_kind},
        {"vertices", study.vertices},     {"strips", study.strips},
        {"iterations", study.iterations}, {"rows", nlohmann::ordered_json::array()}};
    for (const MachineRow& row : study.rows) {
        nlohmann::ordered_json one{{"faster_at", name_of(row.faster)},
                                   {"devices", row.devices},
                                   {"ratio", row.ratio},
                                   {"wait_s", row.wait}};
        for (const Winner w : kWinners) {
            const double time = row.time[static_cast<std::size_t>(w)];
            one[name_of(w) + "_s"] =
                std::isfinite(time) ? nlohmann::ordered_json(time) : nlohmann::ordered_json();
        }
        one["async_window"] = row.window;
        one["async_more_iterations"] = row.more_iterations;
        one["winner"] = name_of(row.winner());
        json["rows"].push_back(std::move(one));
    }
    return json;
}

}  // namespace weft
