#include "simulation/bodies/dataset_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "runtime/io/hdf5/datasets.h"
#include "runtime/io/hdf5/files.h"
#include "simulation/bodies/dataset_choice.h"
#include "simulation/bodies/vtkhdf_frames.h"
#include "simulation/mesh/mesh_text.h"

namespace weft {
namespace {

using Frames = std::vector<std::vector<Vec3>>;

void check_file(const MeshObstacle& obstacle, const std::string& path) {
    std::error_code ignored;
    if (std::filesystem::is_regular_file(path, ignored)) return;
    if (path.find('*') != std::string::npos) {
        refuse_frames(obstacle, "expected one HDF5 file with all frames, without a *");
    }
    refuse_frames(obstacle,
                  std::filesystem::exists(path, ignored) ? "that is no file" : "no such file");
}

bool is_place(Vec3 p) {
    const auto is_near = [](double x) { return std::abs(x) <= kMaxCoordinate; };
    return is_near(p.x) && is_near(p.y) && is_near(p.z);
}

void check_places(const MeshObstacle& obstacle, const std::string& path, const Frames& frames) {
    for (std::size_t f = 0; f < frames.size(); ++f) {
        const auto wrong = std::ranges::find_if_not(frames[f], is_place);
        if (wrong == frames[f].end()) continue;
        refuse_frames(
            obstacle,
            fmt::format("'{}'[{}, {}] = ({}, {}, {}): must be finite and within {} m", path, f,
                        wrong - frames[f].begin(), wrong->x, wrong->y, wrong->z, kMaxCoordinate));
    }
}

/// As many frames at once as are packed together, so that none is unpacked twice.
Frames read_all(const ChosenDataset& chosen, std::size_t vertex_count) {
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    const hid_t dataset = chosen.dataset.id();
    const hsize_t step = std::min(chosen.frames, hdf5::rows_per_chunk(dataset));
    Frames frames;
    std::vector<Vec3> read(step * vertex_count);
    for (hsize_t begin = 0; begin < chosen.frames; begin += step) {
        const hsize_t count = std::min(step, chosen.frames - begin);
        hdf5::read_rows(dataset, H5T_NATIVE_DOUBLE, begin, count, read.data());
        for (hsize_t frame = 0; frame < count; ++frame) {
            const Vec3* first = read.data() + frame * vertex_count;
            frames.emplace_back(first, first + vertex_count);
        }
    }
    return frames;
}

}  // namespace

std::vector<std::vector<Vec3>> read_dataset_frames(const MeshObstacle& obstacle,
                                                   const FrameDataset& source,
                                                   std::size_t vertex_count) {
    check_file(obstacle, source.file);
    const hdf5::Session session;
    try {
        const hdf5::Handle file = hdf5::open_whole(source.file);
        if (source.path.empty() && is_vtkhdf(file)) {
            Frames frames = read_vtkhdf_frames(obstacle, file, vertex_count);
            check_places(obstacle, kVtkhdfPoints, frames);
            return frames;
        }
        const ChosenDataset chosen = choose_dataset(obstacle, source, file, vertex_count);
        Frames frames = read_all(chosen, vertex_count);
        check_places(obstacle, chosen.path, frames);
        return frames;
    } catch (const hdf5::Error& error) {
        refuse_frames(obstacle, fmt::format("cannot read it as HDF5: {}", error.what()));
    }
}

}  // namespace weft
