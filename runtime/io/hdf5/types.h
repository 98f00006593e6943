#pragma once

#include <string>

#include "runtime/io/hdf5/handle.h"

namespace weft::hdf5 {

Handle string_type();  ///< UTF-8, variable length: h5py gives str for it
Handle bool_type();    ///< the enum that h5py reads and writes as bool

/// string_type(), for values that are `stored` as it; throws Error, which begins with `what`, where
/// they are not.
Handle string_type_like(hid_t stored, const std::string& what);
/// Of a single value.
Handle scalar_space();

}  // namespace weft::hdf5
