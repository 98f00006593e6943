#include "apps/weft/studies/study_parts.h"

#include <algorithm>
#include <cmath>

#include "apps/weft/studies/trajectory_study.h"
#include "runtime/error.h"

namespace weft {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kError = "error";
constexpr const char* kTrajectory = "trajectory";

/// One problem has one of each.
void check_same(const std::vector<Json>& parts, const std::vector<const char*>& keys) {
    for (const Json& part : parts) {
        for (const char* key : keys) {
            if (part.at(key) == parts.front().at(key)) continue;
            throw UserError(std::string("the parts of this study are not of one problem: '") + key +
                            "' is " + parts.front().at(key).dump() + " and " + part.at(key).dump());
        }
    }
}

Json curve_json(const ErrorCurve& curve) {
    Json points = Json::array();
    for (const ErrorPoint& p : curve.points) {
        const Json estimate = std::isnan(p.estimate) ? Json() : Json(p.estimate);
        points.push_back({p.iteration, p.time, p.energy, p.relative_error, estimate, p.truncated});
    }
    return {{"solver", curve.solver},
            {"devices", curve.devices},
            {"plan", curve.plan},
            {"points", points},
            {"end", curve.end}};
}

ErrorCurve error_curve(const Json& json) {
    ErrorCurve curve{json.at("solver"), json.at("devices"), json.at("plan"), {}, json.at("end")};
    for (const Json& p : json.at("points")) {
        curve.points.push_back({p[0], p[1], p[2], p[3]});
        if (p[4].is_number()) curve.points.back().estimate = p[4];
        curve.points.back().truncated = p[5];
    }
    return curve;
}

ErrorStudy error_part(const Json& json) {
    ErrorStudy study;
    study.scene = json.at("scene");
    study.frame = json.at("frame");
    study.vertices = json.at("vertices");
    study.step = json.at("step");
    study.energies = json.at("energies").get<std::vector<std::string>>();
    study.notes = json.at("notes").get<std::vector<std::string>>();
    study.rounding_floor = json.at("rounding_floor");
    study.minimum.energy = json.at("reference_energy");
    study.minimum.start_energy = json.at("start_energy");
    const Json& certificate = json.at("certificate");
    study.minimum.certificate = {certificate[0], certificate[1], certificate[2]};
    for (const Json& curve : json.at("curves")) study.curves.push_back(error_curve(curve));
    return study;
}

Json curve_json(const TrajectoryCurve& curve) {
    Json points = Json::array(), unfinished = Json::array();
    for (const TrajectoryPoint& p : curve.points) {
        points.push_back({p.substeps, p.iterations, p.time, p.distance, p.last_distance});
    }
    for (const UnfinishedRun& r : curve.unfinished) {
        unfinished.push_back({r.substeps, r.iterations, r.why});
    }
    return {{"solver", curve.solver},
            {"devices", curve.devices},
            {"plan", curve.plan},
            {"points", points},
            {"unfinished", unfinished}};
}

TrajectoryCurve trajectory_curve(const Json& json) {
    TrajectoryCurve curve{json.at("solver"), json.at("devices"), json.at("plan"), {}, {}};
    for (const Json& p : json.at("points")) {
        curve.points.push_back({p[0], p[1], p[2], p[3], p[4], false});
    }
    for (const Json& r : json.at("unfinished")) curve.unfinished.push_back({r[0], r[1], r[2]});
    return curve;
}

/// E* moves; E0 and the energies stay.
void count_from(ErrorCurve& curve, const Minimum& minimum) {
    for (ErrorPoint& point : curve.points) {
        point.relative_error =
            (point.energy - minimum.energy) / (minimum.start_energy - minimum.energy);
    }
}

}  // namespace

Json to_part(const ErrorStudy& study) {
    Json curves = Json::array();
    for (const ErrorCurve& curve : study.curves) curves.push_back(curve_json(curve));
    const Certificate& certificate = study.minimum.certificate;
    return {{"study", kError},
            {"scene", study.scene},
            {"frame", study.frame},
            {"vertices", study.vertices},
            {"step", study.step},
            {"energies", study.energies},
            {"notes", study.notes},
            {"rounding_floor", study.rounding_floor},
            {"start_energy", study.minimum.start_energy},
            {"reference_energy", study.minimum.energy},
            {"certificate",
             {certificate.relative_gradient, certificate.relative_gap, certificate.iterations}},
            {"curves", curves}};
}

Json to_part(const TrajectoryStudy& study) {
    Json curves = Json::array();
    for (const TrajectoryCurve& curve : study.curves) curves.push_back(curve_json(curve));
    return {{"study", kTrajectory},
            {"scene", study.scene},
            {"frames", study.frames},
            {"vertices", study.vertices},
            {"frame_time", study.frame_time},
            {"reference_by", study.reference_by},
            {"reference_substeps", study.reference_substeps},
            {"doubt", study.doubt},
            {"curves", curves}};
}

ErrorStudy join_error_parts(const std::vector<Json>& parts) {
    check_same(parts, {"study", "scene", "frame", "vertices", "step", "start_energy"});
    ErrorStudy study = error_part(parts.front());
    std::vector<ErrorCurve> curves;
    for (const Json& json : parts) {
        ErrorStudy part = error_part(json);
        std::ranges::move(part.curves, std::back_inserter(curves));
        if (part.minimum.energy < study.minimum.energy) study = std::move(part);
    }
    study.curves = std::move(curves);
    for (ErrorCurve& curve : study.curves) count_from(curve, study.minimum);
    return study;
}

TrajectoryStudy join_trajectory_parts(const std::vector<Json>& parts) {
    check_same(parts, {"study", "scene", "frames", "vertices", "frame_time", "reference_by",
                       "reference_substeps"});
    const Json& first = parts.front();
    TrajectoryStudy study{first.at("scene"),        first.at("frames"),
                          first.at("vertices"),     first.at("frame_time"),
                          first.at("reference_by"), first.at("reference_substeps"),
                          first.at("doubt"),        {}};
    for (const Json& part : parts) {
        for (const Json& curve : part.at("curves")) study.curves.push_back(trajectory_curve(curve));
    }
    mark_front(study.curves);
    return study;
}

bool is_trajectory_part(const Json& part) { return part.value("study", "") == kTrajectory; }

}  // namespace weft
