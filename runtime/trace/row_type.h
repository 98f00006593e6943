#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/io/hdf5/handle.h"

namespace weft::trace {

/// A row as it lies in memory: the frame (or graph) that it belongs to, then the record.
template <class Record>
struct Row {
    std::uint32_t owner = 0;
    Record record;
};

/// A table's columns, as HDF5 knows them.
class RowType {
public:
    struct Column {
        std::string name;
        hid_t type;
        std::size_t offset;
        const char* unit = "";
    };

    /// size: of a row in memory [bytes]. The first column is the row's owner, a std::uint32_t.
    RowType(std::size_t size, const std::vector<Column>& columns);

    hid_t memory() const { return memory_.id(); }
    hid_t file() const { return file_.id(); }              ///< the same columns without gaps
    hid_t owner_only() const { return owner_only_.id(); }  ///< its first column alone
    std::size_t size() const { return size_; }             ///< of a row in memory [bytes]
    const std::vector<std::string>& units() const { return units_; }  ///< [column]

private:
    std::size_t size_;
    std::vector<std::string> units_;
    hdf5::Handle memory_;
    hdf5::Handle file_;
    hdf5::Handle owner_only_;
};

template <class Number>
hid_t native_type();
template <>
inline hid_t native_type<std::uint32_t>() {
    return H5T_NATIVE_UINT32;
}
template <>
inline hid_t native_type<std::uint64_t>() {
    return H5T_NATIVE_UINT64;
}
template <>
inline hid_t native_type<double>() {
    return H5T_NATIVE_DOUBLE;
}

/// Text of so many bytes, filled up with zeros.
hdf5::Handle short_text_type(std::size_t size);
hdf5::Handle compound_type(std::size_t size, const std::vector<RowType::Column>& columns);

}  // namespace weft::trace
