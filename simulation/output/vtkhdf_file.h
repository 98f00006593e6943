#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "runtime/io/compression.h"
#include "runtime/io/hdf5/growing_dataset.h"

namespace weft {

/// The layout of a temporal VTKHDF 2.0 PolyData file whose triangles never change; see
/// docs.vtk.org, "VTKHDF File Format", sections PolyData and Temporal Data.
///
/// All objects of all steps are created at once. A step then only adds a chunk of positions behind
/// the end of the file and an entry to the chunks' index, and when both are on disk, the number of
/// steps is raised in place. So the file is whole at any moment, although HDF5 gives no such
/// promise for files of this (plain) format.
///
/// Not thread-safe: hold an hdf5::Session around every call. Errors are hdf5::Error.
class VtkhdfFile {
public:
    using Triangle = std::array<std::uint32_t, 3>;

    /// bodies  [triangles] number of the body that each triangle belongs to
    VtkhdfFile(const std::string& path, std::span<const Triangle> triangles,
               std::size_t vertex_count, std::span<const std::int32_t> bodies,
               const std::vector<std::string>& body_names, std::size_t step_limit,
               Compression compression);

    /// Adds a step and hands it to the operating system. At most step_limit times.
    /// positions  [3 * vertex_count], as ChunkCodec encodes them
    void append(double time, std::span<const std::byte> positions);
    void close();
    /// After an Error: leaves the file as of the last flush.
    void abandon();

    std::size_t steps() const { return steps_; }
    std::size_t step_limit() const { return step_limit_; }

    /// Virtual dataset [vertices, 3] of one step's positions, for readers of plain HDF5.
    static std::string step_dataset(std::size_t step);

private:
    void create_topology(std::span<const Triangle> triangles, std::span<const std::int32_t> bodies);
    void create_points(Compression compression);
    void create_steps();
    void create_views(const std::vector<std::string>& body_names);
    void raise_step_count(double time);
    void flush();

    hsize_t vertex_count_;
    std::size_t step_limit_;
    std::size_t steps_ = 0;
    hdf5::Handle file_;
    hdf5::Handle root_;
    hdf5::Handle steps_group_;
    hdf5::Handle points_;
    hdf5::GrowingDataset times_;
};

}  // namespace weft
