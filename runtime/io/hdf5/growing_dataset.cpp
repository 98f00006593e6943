#include "runtime/io/hdf5/growing_dataset.h"

#include <utility>

namespace weft::hdf5 {

GrowingDataset::GrowingDataset(hid_t parent, const std::string& name, hid_t file_type,
                               std::vector<hsize_t> row_shape, hsize_t chunk_rows, unsigned deflate)
    : name_(name), row_shape_(std::move(row_shape)) {
    const std::string what = "create dataset '" + name + "'";
    std::vector<hsize_t> extent{0};
    std::vector<hsize_t> limit{H5S_UNLIMITED};
    std::vector<hsize_t> chunk{chunk_rows};
    for (auto* shape : {&extent, &limit, &chunk}) {
        shape->insert(shape->end(), row_shape_.begin(), row_shape_.end());
    }
    const int rank = static_cast<int>(extent.size());
    const Handle space(H5Screate_simple(rank, extent.data(), limit.data()), H5Sclose, what);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, what);
    check(H5Pset_chunk(creation.id(), rank, chunk.data()), what);
    if (deflate > 0) {
        check(H5Pset_shuffle(creation.id()), what);  // equal bytes side by side compress better
        check(H5Pset_deflate(creation.id(), deflate), what);
    }
    dataset_ = Handle(H5Dcreate2(parent, name.c_str(), file_type, space.id(), H5P_DEFAULT,
                                 creation.id(), H5P_DEFAULT),
                      H5Dclose, what);
    // HDF5 zeroes its buffer for converting rows at every write; the default one has a megabyte.
    constexpr std::size_t kConversionBytes = 1 << 16;
    transfer_ = Handle(H5Pcreate(H5P_DATASET_XFER), H5Pclose, what);
    check(H5Pset_buffer(transfer_.id(), kConversionBytes, nullptr, nullptr), what);
}

void GrowingDataset::append(hid_t memory_type, const void* rows, hsize_t count) {
    if (count == 0) return;
    const std::string what = "append to dataset '" + name_ + "'";
    std::vector<hsize_t> start{rows_};
    std::vector<hsize_t> block{count};
    std::vector<hsize_t> extent{rows_ + count};
    start.insert(start.end(), row_shape_.size(), 0);
    for (auto* shape : {&block, &extent}) {
        shape->insert(shape->end(), row_shape_.begin(), row_shape_.end());
    }
    check(H5Dset_extent(dataset_.id(), extent.data()), what);
    const Handle file_space(H5Dget_space(dataset_.id()), H5Sclose, what);
    check(H5Sselect_hyperslab(file_space.id(), H5S_SELECT_SET, start.data(), nullptr, block.data(),
                              nullptr),
          what);
    const Handle memory_space(
        H5Screate_simple(static_cast<int>(block.size()), block.data(), nullptr), H5Sclose, what);
    check(H5Dwrite(dataset_.id(), memory_type, memory_space.id(), file_space.id(), transfer_.id(),
                   rows),
          what);
    rows_ += count;
}

void GrowingDataset::flush() { check(H5Dflush(dataset_.id()), "flush dataset '" + name_ + "'"); }

void GrowingDataset::close() { dataset_.close("close dataset '" + name_ + "'"); }

}  // namespace weft::hdf5
