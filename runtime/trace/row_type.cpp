#include "runtime/trace/row_type.h"

namespace weft::trace {

RowType::RowType(std::size_t size, const std::vector<Column>& columns)
    : size_(size), memory_(compound_type(size, columns)) {
    for (const Column& column : columns) units_.emplace_back(column.unit);
    file_ = hdf5::Handle(H5Tcopy(memory_.id()), H5Tclose, "create a table's row type");
    hdf5::check(H5Tpack(file_.id()), "create a table's row type");
    owner_only_ =
        compound_type(sizeof(std::uint32_t), {{columns.front().name, H5T_NATIVE_UINT32, 0}});
}

hdf5::Handle short_text_type(std::size_t size) {
    constexpr const char* kWhat = "create a table's row type";
    hdf5::Handle type(H5Tcopy(H5T_C_S1), H5Tclose, kWhat);
    hdf5::check(H5Tset_size(type.id(), size), kWhat);
    hdf5::check(H5Tset_strpad(type.id(), H5T_STR_NULLPAD), kWhat);
    return type;
}

hdf5::Handle compound_type(std::size_t size, const std::vector<RowType::Column>& columns) {
    constexpr const char* kWhat = "create a table's row type";
    hdf5::Handle type(H5Tcreate(H5T_COMPOUND, size), H5Tclose, kWhat);
    for (const RowType::Column& column : columns) {
        hdf5::check(H5Tinsert(type.id(), column.name.c_str(), column.offset, column.type), kWhat);
    }
    return type;
}

}  // namespace weft::trace
