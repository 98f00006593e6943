#include "apps/weft/studies/trajectory_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <nlohmann/json.hpp>

#include "apps/weft/output/progress.h"
#include "apps/weft/process/child_process.h"
#include "apps/weft/studies/trajectory_reference.h"
#include "apps/weft/studies/whole_run.h"
#include "runtime/error.h"
#include "runtime/io/json_text.h"

namespace weft {

namespace {

struct Setting {
    int substeps = 0;
    int iterations = 0;

    int work() const { return substeps * iterations; }
};

/// The cheapest first.
std::vector<Setting> settings(const ErrorOptions& options) {
    std::vector<Setting> list;
    for (const int substeps : options.sweep_substeps) {
        for (const int iterations : options.sweep_iterations) {
            const Setting setting{substeps, iterations};
            if (setting.work() <= options.max_work) list.push_back(setting);
        }
    }
    std::ranges::stable_sort(list, {}, &Setting::work);
    return list;
}

TrajectoryPoint to_point(Setting setting, const TimedRun& timed, const Trajectory& reference,
                         int frames) {
    const std::size_t one_frame = reference.size() / static_cast<std::size_t>(frames);
    return {setting.substeps,
            setting.iterations,
            timed.time,
            distance(timed.trajectory, reference),
            distance(timed.trajectory, reference, one_frame),
            false};
}

/// For the pipe between processes.
nlohmann::json to_json(const TrajectoryCurve& curve) {
    nlohmann::json points = nlohmann::json::array();
    for (const TrajectoryPoint& p : curve.points) {
        points.push_back({p.substeps, p.iterations, p.time, p.distance, p.last_distance});
    }
    nlohmann::json unfinished = nlohmann::json::array();
    for (const UnfinishedRun& r : curve.unfinished) {
        unfinished.push_back({r.substeps, r.iterations, r.why});
    }
    return {{"points", points}, {"unfinished", unfinished}};
}

void add_measured(TrajectoryCurve& curve, const nlohmann::json& measured) {
    for (const auto& p : measured["points"]) curve.points.push_back({p[0], p[1], p[2], p[3], p[4]});
    for (const auto& r : measured["unfinished"]) curve.unfinished.push_back({r[0], r[1], r[2]});
}

TrajectoryCurve measure(const ErrorOptions& options, const RunOptions& run,
                        const Trajectory& reference, int frames) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    const double limit = options.time.value_or(60.0);
    const std::vector<Setting> list = settings(options);
    Progress progress(fmt::format("{} on {}, run", *run.solver, run.device),
                      static_cast<int>(list.size()), run.quiet);
    TrajectoryCurve curve;
    for (const Setting& setting : list) {
        const auto leave = [&](const std::string& why) {
            curve.unfinished.push_back({setting.substeps, setting.iterations, why});
        };
        if (std::chrono::duration<double>(Clock::now() - begin).count() > limit) {
            leave(fmt::format("not begun, --time {:g}", limit));
            continue;
        }
        try {
            curve.points.push_back(
                to_point(setting, run_scene(with_steps(run, setting.substeps, setting.iterations)),
                         reference, frames));
        } catch (const RunError& error) {
            leave(error.what());
        }
        progress.show(static_cast<int>(curve.points.size() + curve.unfinished.size()));
    }
    return curve;
}

void check(const ErrorOptions& options) {
    for (const auto& [name, list] : {std::pair("--sweep-substeps", &options.sweep_substeps),
                                     std::pair("--sweep-iterations", &options.sweep_iterations)}) {
        for (const int value : *list) {
            if (value < 1) throw UserError(fmt::format("{} {}: expected 1 or more", name, value));
        }
    }
    if (settings(options).empty()) {
        throw UserError(fmt::format(
            "--max-work {}: no pair of --sweep-substeps and --sweep-iterations has a product so "
            "small",
            options.max_work));
    }
    // Wrong names are to be seen before anything is computed.
    for (const std::string& solver : options.solvers) {
        RunOptions run = options.run;
        run.solver = solver;
        read_scene(run.scene, run.overrides());
    }
    for (const std::string& plan : options.plans) {
        RunOptions run = options.run;
        run.plan = plan;
        static_cast<void>(run.simulation());
    }
}

}  // namespace

void mark_front(std::vector<TrajectoryCurve>& curves) {
    std::vector<TrajectoryPoint*> all;
    for (TrajectoryCurve& curve : curves) {
        for (TrajectoryPoint& point : curve.points) all.push_back(&point);
    }
    std::ranges::stable_sort(all, [](const TrajectoryPoint* a, const TrajectoryPoint* b) {
        return std::pair(a->time, a->distance) < std::pair(b->time, b->distance);
    });
    double nearest = std::numeric_limits<double>::infinity();
    for (TrajectoryPoint* point : all) {
        point->on_front = point->distance < nearest;
        nearest = std::min(nearest, point->distance);
    }
}

TrajectoryStudy study_trajectories(const ErrorOptions& options) {
    check(options);
    const Scene scene = read_scene(options.run.scene, options.run.overrides());
    TrajectoryStudy study;
    study.scene = scene.name;
    study.frames = scene.frames;
    study.frame_time = scene.dt;
    const TrajectoryReference reference = run_reference(options);
    study.vertices = reference.vertices;
    study.reference_by = reference.by;
    study.reference_substeps = reference.substeps;
    study.doubt = reference.doubt;

    for (const std::string& solver : options.solvers) {
        for (const std::string& devices : options.devices) {
            for (const std::string& plan : options.plans) {
                RunOptions run = options.run;
                run.solver = solver;
                run.device = devices;
                run.plan = plan;
                TrajectoryCurve curve{solver, devices, plan, {}, {}};
                const std::string answer =
                    in_child_process(fmt::format("{} on {}", solver, devices), [&] {
                        return json_text(
                            to_json(measure(options, run, reference.trajectory, scene.frames)), -1);
                    });
                add_measured(curve, nlohmann::json::parse(answer));
                study.curves.push_back(std::move(curve));
            }
        }
    }
    mark_front(study.curves);
    return study;
}

}  // namespace weft
