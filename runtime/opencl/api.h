#pragma once

// The Khronos C++ bindings, as everything in this folder uses them: OpenCL 1.2, errors as
// exceptions.

#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_ENABLE_EXCEPTIONS
#include <CL/opencl.hpp>

#include <string>

#include "runtime/error.h"

namespace weft {

/// A driver's error as ours: the call, the code's name, and where it happened.
RunError opencl_error(const std::string& where, const cl::Error& error);

/// "CL_OUT_OF_RESOURCES" for -5, and so on.
std::string opencl_code_name(cl_int code);

}  // namespace weft
