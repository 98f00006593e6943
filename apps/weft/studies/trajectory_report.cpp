#include "apps/weft/studies/trajectory_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/weft/output/csv_text.h"

namespace weft {

namespace {

std::string front_table(const TrajectoryStudy& study) {
    struct Row {
        const TrajectoryCurve* curve;
        const TrajectoryPoint* point;
    };
    std::vector<Row> rows;
    for (const TrajectoryCurve& curve : study.curves) {
        for (const TrajectoryPoint& point : curve.points) rows.push_back({&curve, &point});
    }
    std::ranges::sort(rows, {}, [](const Row& row) { return row.point->time; });
    std::string text =
        fmt::format("\n  {:<8}{:<24}{:<8}{:>9}{:>11}{:>12}{:>12}{:>12}\n", "solver", "devices",
                    "plan", "substeps", "iterations", "time [s]", "RMS [mm]", "at the end");
    for (const auto& [curve, p] : rows) {
        text += fmt::format("{} {:<8}{:<24}{:<8}{:>9}{:>11}{:>12.4f}{:>12.4g}{:>12.4g}{}\n",
                            p->on_front ? '*' : ' ', curve->solver, curve->devices, curve->plan,
                            p->substeps, p->iterations, p->time, 1e3 * p->distance,
                            1e3 * p->last_distance,
                            p->distance < study.doubt ? "  nearer than the reference is sure" : "");
    }
    return text + "* on the Pareto front: no other run is as fast and as near\n";
}

}  // namespace

std::string to_csv(const TrajectoryStudy& study) {
    std::string csv =
        "solver,device,plan,substeps,iterations,time_s,rms_m,last_rms_m,pareto,unfinished\n";
    for (const TrajectoryCurve& curve : study.curves) {
        const std::string start = fmt::format("{},{},{}", curve.solver, curve.devices, curve.plan);
        for (const TrajectoryPoint& p : curve.points) {
            csv += fmt::format("{},{},{},{},{},{},{},\n", start, p.substeps, p.iterations, p.time,
                               p.distance, p.last_distance, p.on_front ? 1 : 0);
        }
        for (const UnfinishedRun& run : curve.unfinished) {
            csv += fmt::format("{},{},{},,,,0,{}\n", start, run.substeps, run.iterations,
                               csv_cell(run.why));
        }
    }
    return csv;
}

std::string to_text(const TrajectoryStudy& study) {
    std::string text = fmt::format(
        "{}: {} frames of {:g} ms, {} vertices\n"
        "reference: {} substeps by {}, {:.3g} mm from itself with half as many\n",
        study.scene, study.frames, 1e3 * study.frame_time, study.vertices, study.reference_substeps,
        study.reference_by, 1e3 * study.doubt);
    text += front_table(study);
    for (const TrajectoryCurve& curve : study.curves) {
        for (const UnfinishedRun& run : curve.unfinished) {
            text += fmt::format("not finished: {} on {} ({}), {} substeps of {} iterations: {}\n",
                                curve.solver, curve.devices, curve.plan, run.substeps,
                                run.iterations, run.why);
        }
    }
    return text;
}

nlohmann::ordered_json to_json(const TrajectoryStudy& study) {
    nlohmann::ordered_json curves = nlohmann::ordered_json::array();
    for (const TrajectoryCurve& curve : study.curves) {
        nlohmann::ordered_json runs = nlohmann::ordered_json::array();
        for (const TrajectoryPoint& p : curve.points) {
            runs.push_back({{"substeps", p.substeps},
                            {"iterations", p.iterations},
                            {"time_s", p.time},
                            {"rms_m", p.distance},
                            {"last_rms_m", p.last_distance},
                            {"pareto", p.on_front}});
        }
        nlohmann::ordered_json unfinished = nlohmann::ordered_json::array();
        for (const UnfinishedRun& r : curve.unfinished) {
            unfinished.push_back(
                {{"substeps", r.substeps}, {"iterations", r.iterations}, {"why", r.why}});
        }
        curves.push_back({{"solver", curve.solver},
                          {"devices", curve.devices},
                          {"plan", curve.plan},
                          {"runs", runs},
                          {"unfinished", unfinished}});
    }
    return {{"scene", study.scene},
            {"frames", study.frames},
            {"vertices", study.vertices},
            {"reference",
             {{"by", study.reference_by},
              {"substeps", study.reference_substeps},
              {"doubt_m", study.doubt}}},
            {"curves", curves}};
}

}  // namespace weft
