#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace weft {

/// The XDMF text beside a VtkhdfFile: one temporal collection, whose grids point into that file by
/// its name, which readers look up in the folder of the .xdmf file. It is whole after every append.
/// Errors are RunError.
class XdmfFile {
public:
    /// data_file  name of the HDF5 file, in the same folder
    XdmfFile(const std::filesystem::path& path, const std::string& data_file,
             std::size_t triangle_count, std::size_t vertex_count);

    /// positions  path of the step's dataset [vertices, 3] in the data file
    void append(double time, const std::string& positions);
    void close();

private:
    void check() const;

    std::filesystem::path path_;
    std::string data_file_;
    std::size_t triangle_count_;
    std::size_t vertex_count_;
    std::ofstream stream_;
    std::streampos end_of_grids_;
};

}  // namespace weft
