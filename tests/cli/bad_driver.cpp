// Poses as an OpenCL driver with one platform that is no good. $WEFT_BAD_DRIVER says why:
//   crash    a call ends the process
//   missing  a call is not there
//   load     it ends the process while it is loaded

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl_icd.h>
#include <cstdlib>
#include <cstring>
#include <string>

struct _cl_platform_id {
    const cl_icd_dispatch* calls;
};

namespace {

bool is(const char* kind) {
    const char* set = std::getenv("WEFT_BAD_DRIVER");
    return set != nullptr && std::strcmp(set, kind) == 0;
}

/// Not by raise(): a driver beside this one may have a handler that only stops real ones.
/// Sanitizers would report the store instead of doing it.
__attribute__((no_sanitize("undefined"))) void crash() {
    volatile int* volatile nowhere = nullptr;
    *nowhere = 1;
}

[[gnu::constructor]] void load() {
    if (is("load")) crash();
}

cl_int CL_API_CALL platform_info(cl_platform_id, cl_platform_info what, size_t size, void* value,
                                 size_t* needed) {
    std::string text = "OpenCL 1.2 bad";
    if (what == CL_PLATFORM_NAME) text = "Bad driver";
    if (what == CL_PLATFORM_EXTENSIONS) text = "cl_khr_icd";
    if (what == CL_PLATFORM_ICD_SUFFIX_KHR) text = "BAD";
    if (needed != nullptr) *needed = text.size() + 1;
    if (value != nullptr && size > text.size()) std::memcpy(value, text.c_str(), text.size() + 1);
    return CL_SUCCESS;
}

cl_int CL_API_CALL device_ids(cl_platform_id, cl_device_type, cl_uint, cl_device_id*, cl_uint*) {
    crash();
    return CL_SUCCESS;
}

cl_platform_id the_platform() {
    static cl_icd_dispatch calls{};
    static _cl_platform_id platform{&calls};
    calls.clGetPlatformInfo = platform_info;
    calls.clGetDeviceIDs = is("missing") ? nullptr : device_ids;
    return &platform;
}

cl_int CL_API_CALL platform_ids(cl_uint count, cl_platform_id* platforms, cl_uint* available) {
    if (available != nullptr) *available = 1;
    if (platforms != nullptr && count > 0) *platforms = the_platform();
    return CL_SUCCESS;
}

}  // namespace

extern "C" void* CL_API_CALL clGetExtensionFunctionAddress(const char* name) {
    if (std::strcmp(name, "clIcdGetPlatformIDsKHR") == 0)
        return reinterpret_cast<void*>(platform_ids);
    return nullptr;
}

extern "C" cl_int CL_API_CALL clGetPlatformInfo(cl_platform_id platform, cl_platform_info what,
                                                size_t size, void* value, size_t* needed) {
    return platform_info(platform, what, size, value, needed);
}
