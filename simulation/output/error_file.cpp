#include "simulation/output/error_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "runtime/io/hdf5/attributes.h"
#include "runtime/io/hdf5/datasets.h"
#include "runtime/io/hdf5/files.h"
#include "runtime/io/hdf5_file.h"
#include "simulation/output/point_column.h"

namespace weft {

namespace {

void write_curve(hid_t parent, const std::string& name, const ErrorCurve& curve) {
    const hdf5::Handle group = hdf5::create_group(parent, name);
    hdf5::write_text_attribute(group.id(), "solver", curve.solver);
    hdf5::write_text_attribute(group.id(), "device", curve.devices);
    hdf5::write_text_attribute(group.id(), "plan", curve.plan);
    hdf5::write_text_attribute(group.id(), "end", curve.end);
    write_column<int>(group.id(), "iteration", curve.points, &ErrorPoint::iteration);
    write_column<double>(group.id(), "time_s", curve.points, &ErrorPoint::time);
    write_column<double>(group.id(), "energy", curve.points, &ErrorPoint::energy);
    write_column<double>(group.id(), "relative_error", curve.points, &ErrorPoint::relative_error);
    write_column<double>(group.id(), "relative_error_estimate", curve.points,
                         &ErrorPoint::estimate);
    write_column<int>(group.id(), "truncated", curve.points, &ErrorPoint::truncated);
}

void write_reference(hid_t parent, const ErrorStudy& study) {
    const hdf5::Handle reference = hdf5::create_group(parent, "reference");
    const Minimum& minimum = study.minimum;
    hdf5::write_number(reference.id(), "start_energy", minimum.start_energy);
    hdf5::write_number(reference.id(), "energy", minimum.energy);
    hdf5::write_number(reference.id(), "relative_gradient", minimum.certificate.relative_gradient);
    hdf5::write_number(reference.id(), "relative_gap", minimum.certificate.relative_gap);
    hdf5::write_number(reference.id(), "rounding_floor", study.rounding_floor);
}

void write_curves(hid_t parent, const ErrorStudy& study) {
    const hdf5::Handle curves = hdf5::create_group(parent, "curves");
    for (std::size_t c = 0; c < study.curves.size(); ++c) {
        write_curve(curves.id(), fmt::format("{:03}", c), study.curves[c]);
    }
}

void write_study(hid_t file, const ErrorStudy& study) {
    hdf5::write_text_attribute(file, "scene", study.scene);
    hdf5::write_text_attribute(file, "energies",
                               fmt::format("{}", fmt::join(study.energies, "\n")));
    hdf5::write_text_attribute(file, "notes", fmt::format("{}", fmt::join(study.notes, "\n")));
    const std::array<int, 1> frame = {study.frame};
    hdf5::write_int_attribute(file, "frame", frame);

    write_reference(file, study);
    write_curves(file, study);
}

}  // namespace

void write_error_file(const std::filesystem::path& path, const ErrorStudy& study) {
    write_hdf5_file(path, "weft-error", [&](hid_t file) { write_study(file, study); });
}

}  // namespace weft
