#include "simulation/bodies/vtkhdf_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "runtime/io/hdf5/attributes.h"
#include "runtime/io/hdf5/datasets.h"
#include "runtime/io/hdf5/files.h"
#include "simulation/bodies/dataset_choice.h"

namespace weft {
namespace {

using Numbers = std::vector<std::int64_t>;

Numbers read_numbers(const hdf5::Handle& file, const std::string& name, hsize_t count) {
    const hdf5::Handle dataset = hdf5::open_dataset(file.id(), name);
    Numbers numbers(count);
    if (count > 0) hdf5::read_rows(dataset.id(), H5T_NATIVE_INT64, 0, count, numbers.data());
    return numbers;
}

Numbers read_numbers(const hdf5::Handle& file, const std::string& name) {
    const hdf5::Handle dataset = hdf5::open_dataset(file.id(), name);
    const std::vector<hsize_t> shape = hdf5::shape_of(dataset.id());
    return read_numbers(file, name, shape.empty() ? 0 : shape.front());
}

/// There may be room for more.
hsize_t step_count(const MeshObstacle& obstacle, const hdf5::Handle& file) {
    const std::string name = "VTKHDF/Steps";
    if (!hdf5::exists(file.id(), name)) {
        refuse_frames(obstacle, "a VTKHDF file without steps (VTKHDF/Steps): nothing in it moves");
    }
    const hdf5::Handle steps(H5Gopen2(file.id(), name.c_str(), H5P_DEFAULT), H5Gclose,
                             "open " + name);
    const int count = hdf5::read_int_attribute(steps.id(), "NSteps");
    if (count <= 0) refuse_frames(obstacle, "has no step yet");
    return static_cast<hsize_t>(count);
}

/// NumberOfPoints has an entry for each part, and steps may share parts.
void check_counts(const MeshObstacle& obstacle, const hdf5::Handle& file, hsize_t steps,
                  std::size_t vertex_count) {
    const Numbers points = read_numbers(file, "VTKHDF/NumberOfPoints");
    const Numbers parts = read_numbers(file, "VTKHDF/Steps/NumberOfParts", steps);
    const Numbers offsets = read_numbers(file, "VTKHDF/Steps/PartOffsets", steps);
    for (hsize_t step = 0; step < steps; ++step) {
        const auto part = static_cast<std::size_t>(offsets[step]);
        if (parts[step] != 1 || part >= points.size()) {
            refuse_frames(obstacle, fmt::format("step {} is in several parts, or in none", step));
        }
        if (points[part] == static_cast<std::int64_t>(vertex_count)) continue;
        refuse_frames(obstacle, fmt::format("the bodies in it have {} vertices in step {}, and "
                                            "obstacle '{}' has {}",
                                            points[part], step, obstacle.name, vertex_count));
    }
}

}  // namespace

bool is_vtkhdf(const hdf5::Handle& file) { return hdf5::exists(file.id(), "VTKHDF"); }

/// A run's points are packed step by step.
std::vector<std::vector<Vec3>> read_vtkhdf_frames(const MeshObstacle& obstacle,
                                                  const hdf5::Handle& file,
                                                  std::size_t vertex_count) {
    const hsize_t steps = step_count(obstacle, file);
    check_counts(obstacle, file, steps, vertex_count);
    const hdf5::Handle points = open_points(obstacle, file, kVtkhdfPoints);
    std::vector<std::vector<Vec3>> frames;
    for (const std::int64_t first : read_numbers(file, "VTKHDF/Steps/PointOffsets", steps)) {
        std::vector<Vec3>& frame = frames.emplace_back(vertex_count);
        hdf5::read_rows(points.id(), H5T_NATIVE_DOUBLE, static_cast<hsize_t>(first), vertex_count,
                        frame.data());
    }
    return frames;
}

}  // namespace weft
