#include "simulation/output/vtkhdf_file.h"

#include <algorithm>

#include "runtime/io/hdf5/attributes.h"
#include "runtime/io/hdf5/datasets.h"
#include "runtime/io/hdf5/files.h"
#include "simulation/output/chunk_codec.h"

namespace weft {

namespace {

using hdf5::Handle;
using Triangle = VtkhdfFile::Triangle;

/// Up to here the chunks' index is one node, which changes in one write. 40 bytes per step.
constexpr std::size_t kStepsPerNode = 1024;

constexpr std::size_t kPolyDataKinds = 4;  // Vertices, Lines, Polygons, Strips

/// VTK asks for a type of fixed length here.
void write_fixed_text(hid_t object, const std::string& name, const std::string& value) {
    const std::string what = "write attribute '" + name + "'";
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, what);
    hdf5::check(H5Tset_size(type.id(), value.size()), what);
    hdf5::check(H5Tset_strpad(type.id(), H5T_STR_NULLPAD), what);
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose, what);
    const Handle attribute(
        H5Acreate2(object, name.c_str(), type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
        what);
    hdf5::check(H5Awrite(attribute.id(), type.id(), value.data()), what);
}

void write_numbers(hid_t parent, const std::string& name, const std::vector<std::int64_t>& values) {
    const hsize_t shape[] = {values.size()};
    hdf5::write_array(parent, name, H5T_NATIVE_INT64, shape, values.data());
}

/// One of the four kinds of cells that a PolyData has, all with three corners.
void write_cells(hid_t root, const std::string& name, std::span<const Triangle> triangles) {
    std::vector<std::int64_t> connectivity;
    std::vector<std::int64_t> offsets{0};
    connectivity.reserve(3 * triangles.size());
    offsets.reserve(triangles.size() + 1);
    for (const Triangle& triangle : triangles) {
        connectivity.insert(connectivity.end(), triangle.begin(), triangle.end());
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    }
    const Handle group = hdf5::create_group(root, name);
    write_numbers(group.id(), "NumberOfCells", {static_cast<std::int64_t>(triangles.size())});
    write_numbers(group.id(), "NumberOfConnectivityIds",
                  {static_cast<std::int64_t>(connectivity.size())});
    write_numbers(group.id(), "Connectivity", connectivity);
    write_numbers(group.id(), "Offsets", offsets);
}

}  // namespace

VtkhdfFile::VtkhdfFile(const std::string& path, std::span<const Triangle> triangles,
                       std::size_t vertex_count, std::span<const std::int32_t> bodies,
                       const std::vector<std::string>& body_names, std::size_t step_limit,
                       Compression compression)
    : vertex_count_(vertex_count),
      step_limit_(step_limit),
      file_(hdf5::create_file(path, hdf5::FileFormat::kPlain,
                              std::clamp<std::size_t>(step_limit, 2, kStepsPerNode))),
      root_(hdf5::create_group(file_.id(), "VTKHDF")) {
    const int version[] = {2, 0};
    hdf5::write_int_attribute(root_.id(), "Version", version);
    write_fixed_text(root_.id(), "Type", "PolyData");
    create_topology(triangles, bodies);
    create_points(compression);
    create_steps();
    create_views(body_names);
    flush();
    hdf5::publish(path);
}

void VtkhdfFile::create_topology(std::span<const Triangle> triangles,
                                 std::span<const std::int32_t> bodies) {
    write_numbers(root_.id(), "NumberOfPoints", {static_cast<std::int64_t>(vertex_count_)});
    for (const char* unused : {"Vertices", "Lines", "Strips"}) write_cells(root_.id(), unused, {});
    write_cells(root_.id(), "Polygons", triangles);

    const Handle cell_data = hdf5::create_group(root_.id(), "CellData");
    const hsize_t shape[] = {bodies.size()};
    hdf5::write_array(cell_data.id(), "body", H5T_NATIVE_INT32, shape, bodies.data());
}

/// A chunk is one step's positions, so that a step is compressed once and read alone.
void VtkhdfFile::create_points(Compression compression) {
    constexpr const char* kWhat = "create dataset 'Points'";
    const hsize_t shape[] = {step_limit_ * vertex_count_, 3};
    const hsize_t chunk[] = {vertex_count_, 3};
    const Handle space(H5Screate_simple(2, shape, nullptr), H5Sclose, kWhat);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, kWhat);
    hdf5::check(H5Pset_chunk(creation.id(), 2, chunk), kWhat);
    if (const int level = deflate_level(compression); level > 0) {
        hdf5::check(H5Pset_shuffle(creation.id()), kWhat);
        hdf5::check(H5Pset_deflate(creation.id(), static_cast<unsigned>(level)), kWhat);
    }
    points_ = Handle(H5Dcreate2(root_.id(), "Points", H5T_IEEE_F32LE, space.id(), H5P_DEFAULT,
                                creation.id(), H5P_DEFAULT),
                     H5Dclose, kWhat);
}

/// Every step has one part, its own positions, and the triangles and bodies of all steps.
void VtkhdfFile::create_steps() {
    steps_group_ = hdf5::create_group(root_.id(), "Steps");
    const hid_t group = steps_group_.id();
    const int none[] = {0};
    hdf5::write_int_attribute(group, "NSteps", none);

    const std::vector<std::int64_t> zeros(step_limit_ * kPolyDataKinds, 0);
    std::vector<std::int64_t> point_offsets;
    for (std::size_t i = 0; i < step_limit_; ++i) {
        point_offsets.push_back(static_cast<std::int64_t>(i * vertex_count_));
    }
    const hsize_t steps[] = {step_limit_};
    const hsize_t by_kind[] = {step_limit_, kPolyDataKinds};
    times_ = {group, "Values", H5T_NATIVE_DOUBLE, {}, kStepsPerNode, 0};
    write_numbers(group, "NumberOfParts", std::vector<std::int64_t>(step_limit_, 1));
    write_numbers(group, "PointOffsets", point_offsets);
    hdf5::write_array(group, "PartOffsets", H5T_NATIVE_INT64, steps, zeros.data());
    for (const char* name : {"CellOffsets", "ConnectivityIdOffsets"}) {
        hdf5::write_array(group, name, H5T_NATIVE_INT64, by_kind, zeros.data());
    }
    const Handle cell_data = hdf5::create_group(group, "CellDataOffsets");
    hdf5::write_array(cell_data.id(), "body", H5T_NATIVE_INT64, steps, zeros.data());
}

/// Readers of VTKHDF ignore what is outside of its group.
void VtkhdfFile::create_views(const std::vector<std::string>& body_names) {
    constexpr const char* kWhat = "create a step's virtual dataset";
    const Handle group = hdf5::create_group(file_.id(), "weft");
    hdf5::write_texts(group.id(), "bodies", body_names);

    const hsize_t shape[] = {vertex_count_, 3};
    const Handle space(H5Screate_simple(2, shape, nullptr), H5Sclose, kWhat);
    const Handle source(H5Dget_space(points_.id()), H5Sclose, kWhat);
    for (std::size_t step = 0; step < step_limit_; ++step) {
        const hsize_t start[] = {step * vertex_count_, 0};
        hdf5::check(
            H5Sselect_hyperslab(source.id(), H5S_SELECT_SET, start, nullptr, shape, nullptr),
            kWhat);
        const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, kWhat);
        hdf5::check(H5Pset_virtual(creation.id(), space.id(), ".", "/VTKHDF/Points", source.id()),
                    kWhat);
        const Handle view(H5Dcreate2(file_.id(), step_dataset(step).c_str(), H5T_NATIVE_FLOAT,
                                     space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT),
                          H5Dclose, kWhat);
    }
}

/// Past the library's own filters: they have been applied already.
void VtkhdfFile::append(double time, std::span<const std::byte> positions) {
    constexpr const char* kWhat = "write positions";
    const hsize_t start[] = {steps_ * vertex_count_, 0};
    hdf5::check(H5Dwrite_chunk(points_.id(), H5P_DEFAULT, /*filters=*/0, start, positions.size(),
                               positions.data()),
                kWhat);
    hdf5::check(H5Dflush(points_.id()), kWhat);
    flush();
    raise_step_count(time);
}

/// NSteps comes first: VTK reserves room for so many times, and would write past it if there were
/// more of them.
void VtkhdfFile::raise_step_count(double time) {
    ++steps_;
    const int count[] = {static_cast<int>(steps_)};
    hdf5::write_int_attribute(steps_group_.id(), "NSteps", count);
    flush();
    times_.append(H5T_NATIVE_DOUBLE, &time, 1);
    flush();
}

void VtkhdfFile::flush() { hdf5::check(H5Fflush(file_.id(), H5F_SCOPE_GLOBAL), "write"); }

void VtkhdfFile::close() {
    times_.close();
    for (Handle* handle : {&points_, &steps_group_, &root_, &file_}) handle->close("close");
}

void VtkhdfFile::abandon() {
    times_.abandon();
    for (Handle* handle : {&points_, &steps_group_, &root_, &file_}) handle->abandon();
}

std::string VtkhdfFile::step_dataset(std::size_t step) {
    return "/weft/positions_" + std::to_string(step);
}

}  // namespace weft
