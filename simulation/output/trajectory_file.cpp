#include "simulation/output/trajectory_file.h"

#include <fmt/format.h>

#include <array>

#include "runtime/io/hdf5/attributes.h"
#include "runtime/io/hdf5/datasets.h"
#include "runtime/io/hdf5/files.h"
#include "runtime/io/hdf5_file.h"
#include "simulation/output/point_column.h"

namespace weft {

namespace {

void write_curve(hid_t parent, const std::string& name, const TrajectoryCurve& curve) {
    const hdf5::Handle group = hdf5::create_group(parent, name);
    const hid_t id = group.id();
    hdf5::write_text_attribute(id, "solver", curve.solver);
    hdf5::write_text_attribute(id, "device", curve.devices);
    hdf5::write_text_attribute(id, "plan", curve.plan);
    std::string unfinished;
    for (const UnfinishedRun& run : curve.unfinished) {
        unfinished += fmt::format("{} x {}: {}\n", run.substeps, run.iterations, run.why);
    }
    hdf5::write_text_attribute(id, "unfinished", unfinished);
    write_column<int>(id, "substeps", curve.points, &TrajectoryPoint::substeps);
    write_column<int>(id, "iterations", curve.points, &TrajectoryPoint::iterations);
    write_column<double>(id, "time_s", curve.points, &TrajectoryPoint::time);
    write_column<double>(id, "rms_m", curve.points, &TrajectoryPoint::distance);
    write_column<double>(id, "last_rms_m", curve.points, &TrajectoryPoint::last_distance);
    write_column<int>(id, "pareto", curve.points, &TrajectoryPoint::on_front);
}

void write_reference(hid_t parent, const TrajectoryStudy& study) {
    const hdf5::Handle reference = hdf5::create_group(parent, "reference");
    hdf5::write_text_attribute(reference.id(), "by", study.reference_by);
    const std::array<int, 1> substeps = {study.reference_substeps};
    hdf5::write_int_attribute(reference.id(), "substeps", substeps);
    hdf5::write_number(reference.id(), "doubt_m", study.doubt);
}

void write_curves(hid_t parent, const TrajectoryStudy& study) {
    const hdf5::Handle curves = hdf5::create_group(parent, "curves");
    for (std::size_t c = 0; c < study.curves.size(); ++c) {
        write_curve(curves.id(), fmt::format("{:03}", c), study.curves[c]);
    }
}

void write_study(hid_t file, const TrajectoryStudy& study) {
    hdf5::write_text_attribute(file, "scene", study.scene);
    const std::array<int, 1> frames = {study.frames};
    hdf5::write_int_attribute(file, "frames", frames);

    write_reference(file, study);
    write_curves(file, study);
}

}  // namespace

void write_trajectory_file(const std::filesystem::path& path, const TrajectoryStudy& study) {
    write_hdf5_file(path, "weft-trajectory", [&](hid_t file) { write_study(file, study); });
}

}  // namespace weft
