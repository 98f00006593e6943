#include "runtime/io/hdf5/types.h"

namespace weft::hdf5 {

Handle string_type() {
    Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "create a text type");
    check(H5Tset_size(type.id(), H5T_VARIABLE), "create a text type");
    check(H5Tset_cset(type.id(), H5T_CSET_UTF8), "create a text type");
    return type;
}

Handle bool_type() {
    Handle type(H5Tenum_create(H5T_NATIVE_INT8), H5Tclose, "create a bool type");
    const signed char no = 0;
    const signed char yes = 1;
    check(H5Tenum_insert(type.id(), "FALSE", &no), "create a bool type");
    check(H5Tenum_insert(type.id(), "TRUE", &yes), "create a bool type");
    return type;
}

Handle string_type_like(hid_t stored, const std::string& what) {
    if (H5Tget_class(stored) != H5T_STRING || H5Tis_variable_str(stored) <= 0) {
        throw Error(what + ": it is not text of variable length");
    }
    return string_type();
}

Handle scalar_space() { return {H5Screate(H5S_SCALAR), H5Sclose, "create a dataspace"}; }

}  // namespace weft::hdf5
