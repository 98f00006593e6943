#include "simulation/output/error_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "runtime/error.h"
#include "runtime/io/hdf5.h"

namespace weft {

namespace {

template <class Value>
void write_column(hid_t group, const std::string& name, hid_t type, const ErrorCurve& curve,
                  Value ErrorPoint::*member) {
    std::vector<Value> values;
    for (const ErrorPoint& point : curve.points) values.push_back(point.*member);
    const std::array<hsize_t, 1> shape = {values.size()};
    hdf5::write_array(group, name, type, shape, values.data());
}

void write_number(hid_t group, const std::string& name, double value) {
    const std::array<hsize_t, 1> shape = {1};
    hdf5::write_array(group, name, H5T_NATIVE_DOUBLE, shape, &value);
}

void write_curve(hid_t parent, const std::string& name, const ErrorCurve& curve) {
    const hdf5::Handle group = hdf5::create_group(parent, name);
    hdf5::write_text_attribute(group.id(), "solver", curve.solver);
    hdf5::write_text_attribute(group.id(), "device", curve.devices);
    hdf5::write_text_attribute(group.id(), "plan", curve.plan);
    hdf5::write_text_attribute(group.id(), "end", curve.end);
    write_column(group.id(), "iteration", H5T_NATIVE_INT, curve, &ErrorPoint::iteration);
    write_column(group.id(), "time_s", H5T_NATIVE_DOUBLE, curve, &ErrorPoint::time);
    write_column(group.id(), "energy", H5T_NATIVE_DOUBLE, curve, &ErrorPoint::energy);
    write_column(group.id(), "relative_error", H5T_NATIVE_DOUBLE, curve,
                 &ErrorPoint::relative_error);
    write_column(group.id(), "relative_error_estimate", H5T_NATIVE_DOUBLE, curve,
                 &ErrorPoint::estimate);
    write_column(group.id(), "truncated", H5T_NATIVE_INT, curve, &ErrorPoint::truncated);
}

void write_reference(hid_t parent, const ErrorStudy& study) {
    const hdf5::Handle reference = hdf5::create_group(parent, "reference");
    const Minimum& minimum = study.minimum;
    write_number(reference.id(), "start_energy", minimum.start_energy);
    write_number(reference.id(), "energy", minimum.energy);
    write_number(reference.id(), "relative_gradient", minimum.certificate.relative_gradient);
    write_number(reference.id(), "relative_gap", minimum.certificate.relative_gap);
    write_number(reference.id(), "rounding_floor", study.rounding_floor);
}

void write_curves(hid_t parent, const ErrorStudy& study) {
    const hdf5::Handle curves = hdf5::create_group(parent, "curves");
    for (std::size_t c = 0; c < study.curves.size(); ++c) {
        write_curve(curves.id(), fmt::format("{:03}", c), study.curves[c]);
    }
}

void write_study(const std::string& path, const ErrorStudy& study) {
    const hdf5::Session session;
    hdf5::Handle file = hdf5::create_file(path, hdf5::FileFormat::kPlain);
    hdf5::write_text_attribute(file.id(), "format", "weft-error");
    hdf5::write_text_attribute(file.id(), "scene", study.scene);
    hdf5::write_text_attribute(file.id(), "energies",
                               fmt::format("{}", fmt::join(study.energies, "\n")));
    hdf5::write_text_attribute(file.id(), "notes", fmt::format("{}", fmt::join(study.notes, "\n")));
    const std::array<int, 1> frame = {study.frame};
    hdf5::write_int_attribute(file.id(), "frame", frame);

    write_reference(file.id(), study);
    write_curves(file.id(), study);
    file.close("close the file");
}

}  // namespace

void write_error_file(const std::filesystem::path& path, const ErrorStudy& study) {
    try {
        write_study(path.string(), study);
        hdf5::publish(path.string());
    } catch (const hdf5::Error& error) {
        throw RunError(path.string() + ": " + error.what());
    }
}

}  // namespace weft
