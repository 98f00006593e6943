#pragma once

#include <string>
#include <vector>

#include "runtime/io/hdf5/handle.h"

namespace weft::hdf5 {

/// A dataset that grows along its first dimension.
class GrowingDataset {
public:
    GrowingDataset() = default;
    /// row_shape    extents of the other dimensions; empty for a table
    /// chunk_rows   rows compressed and read together
    /// deflate      0 = stored as is, so that rewriting a half-filled chunk takes no new space
    GrowingDataset(hid_t parent, const std::string& name, hid_t file_type,
                   std::vector<hsize_t> row_shape, hsize_t chunk_rows, unsigned deflate);

    /// Adds `count` rows of `memory_type` at the end.
    void append(hid_t memory_type, const void* rows, hsize_t count);
    /// Hands everything to the operating system: from here on it survives the process.
    void flush();
    void close();
    void abandon() { dataset_.abandon(); }

    const std::string& name() const { return name_; }
    hid_t id() const { return dataset_.id(); }
    hsize_t rows() const { return rows_; }

private:
    std::string name_;
    Handle dataset_;
    Handle transfer_;
    std::vector<hsize_t> row_shape_;
    hsize_t rows_ = 0;
};

}  // namespace weft::hdf5
