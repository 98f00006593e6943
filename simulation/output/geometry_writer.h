#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/io/compression.h"

namespace weft {

/// A stretch of the triangles, in their order: one body of the scene.
struct GeometryBody {
    std::string name;
    std::uint32_t triangle_count = 0;
};

/// The positions over time, for ParaView and VTK: frames.vtkhdf (VTKHDF 2.0, temporal PolyData;
/// triangles stored once, positions of each step float32, compressed, the cell array `body` numbers
/// the bodies), and beside it frames.xdmf, which points into the same file for readers that do not
/// know temporal VTKHDF (ParaView before 5.12).
///
/// Both files are whole after every step: other programs may open them while the run goes on, and
/// a killed run leaves the steps so far. Writing happens on a background thread; errors are
/// RunError with the path and what failed, out of the next `append` or `finish`, and the steps
/// before are on disk.
/// One thread at a time may call the members.
class GeometryWriter {
public:
    using Triangle = std::array<std::uint32_t, 3>;  ///< vertices, counter-clockwise from outside

    /// path        the .vtkhdf file; the .xdmf file has its name. Existing ones are replaced.
    /// step_count  the most that will be appended. Everything but the positions is laid out in
    ///             advance, so that no kill -9 finds the file's structure half-changed.
    GeometryWriter(const std::filesystem::path& path, std::span<const Triangle> triangles,
                   std::size_t vertex_count, const std::vector<GeometryBody>& bodies,
                   std::size_t step_count, Compression compression = Compression::kFast);

    /// Writes out what was appended.
    ~GeometryWriter();

    GeometryWriter(const GeometryWriter&) = delete;
    GeometryWriter& operator=(const GeometryWriter&) = delete;

    /// Waits only if the step before is not yet written.
    /// time       simulated [s], rising
    /// positions  [3 * vertex_count] x y z of each vertex [m]
    void append(double time, std::vector<float> positions);
    /// positions: called on the background thread.
    void append(double time, std::function<std::vector<float>()> positions);

    /// Waits until everything is written, and closes the files.
    void finish();

    /// The .xdmf file beside the .vtkhdf file.
    static std::filesystem::path xdmf_path(const std::filesystem::path& path);

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace weft
