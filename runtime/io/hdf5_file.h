#pragma once

#include <filesystem>
#include <string>

#include "runtime/error.h"
#include "runtime/io/hdf5/attributes.h"
#include "runtime/io/hdf5/files.h"

namespace weft {

/// Writes an HDF5 file, whole or not at all: its attribute `format`, and what fill(id of the file)
/// puts into it. Throws RunError.
template <class Fill>
void write_hdf5_file(const std::filesystem::path& path, const std::string& format, Fill fill) {
    const hdf5::Session session;
    try {
        hdf5::Handle file = hdf5::create_file(path.string(), hdf5::FileFormat::kPlain);
        hdf5::write_text_attribute(file.id(), "format", format);
        fill(file.id());
        file.close("close the file");
        hdf5::publish(path.string());
    } catch (const hdf5::Error& error) {
        throw RunError(path.string() + ": " + error.what());
    }
}

}  // namespace weft
