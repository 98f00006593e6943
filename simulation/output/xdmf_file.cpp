#include "simulation/output/xdmf_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include "runtime/error.h"
#include "simulation/output/xml_text.h"

namespace weft {

namespace {

constexpr const char* kHead = R"(<?xml version="1.0" ?>
<!-- Made by Weft for readers without temporal VTKHDF. Newer ones: open the .vtkhdf file. -->
<Xdmf Version="2.0">
<Domain>
<Grid Name="frames" GridType="Collection" CollectionType="Temporal">
)";

constexpr const char* kTail = "</Grid>\n</Domain>\n</Xdmf>\n";

constexpr const char* kGrid = R"(<Grid Name="bodies">
<Time Value="{time}" />
<Topology TopologyType="Triangle" NumberOfElements="{triangles}">
<DataItem Dimensions="{triangles} 3" NumberType="Int" Precision="8" Format="HDF">{file}:/VTKHDF/Polygons/Connectivity</DataItem>
</Topology>
<Geometry GeometryType="XYZ">
<DataItem Dimensions="{vertices} 3" NumberType="Float" Precision="4" Format="HDF">{file}:{positions}</DataItem>
</Geometry>
<Attribute Name="body" AttributeType="Scalar" Center="Cell">
<DataItem Dimensions="{triangles}" NumberType="Int" Precision="4" Format="HDF">{file}:/VTKHDF/CellData/body</DataItem>
</Attribute>
</Grid>
)";

}  // namespace

XdmfFile::XdmfFile(const std::filesystem::path& path, const std::string& data_file,
                   std::size_t triangle_count, std::size_t vertex_count)
    : path_(path),
      data_file_(xml_text(data_file)),
      triangle_count_(triangle_count),
      vertex_count_(vertex_count),
      stream_(path, std::ios::binary | std::ios::trunc) {
    stream_ << kHead;
    end_of_grids_ = stream_.tellp();
    stream_ << kTail << std::flush;
    check();
}

/// Overwrites the closing tags with the grid and new ones, in one write.
void XdmfFile::append(double time, const std::string& positions) {
    const std::string grid =
        fmt::format(kGrid, fmt::arg("time", time), fmt::arg("triangles", triangle_count_),
                    fmt::arg("vertices", vertex_count_), fmt::arg("file", data_file_),
                    fmt::arg("positions", positions));
    stream_.seekp(end_of_grids_);
    stream_ << grid + kTail << std::flush;
    check();
    end_of_grids_ += static_cast<std::streamoff>(grid.size());
}

void XdmfFile::close() {
    stream_.close();
    check();
}

void XdmfFile::check() const {
    if (stream_) return;
    const std::string reason = errno != 0 ? std::strerror(errno) : "write failed";
    throw RunError(path_.string() + ": cannot write the geometry: " + reason);
}

}  // namespace weft
