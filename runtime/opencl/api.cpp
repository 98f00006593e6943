#include "runtime/opencl/api.h"

#include <algorithm>
#include <iterator>

namespace weft {

namespace {

struct CodeName {
    cl_int code;
    const char* name;
};

#define WEFT_CODE(code) \
    { code, #code }
constexpr CodeName kCodes[] = {
    WEFT_CODE(CL_DEVICE_NOT_FOUND),
    WEFT_CODE(CL_DEVICE_NOT_AVAILABLE),
    WEFT_CODE(CL_COMPILER_NOT_AVAILABLE),
    WEFT_CODE(CL_MEM_OBJECT_ALLOCATION_FAILURE),
    WEFT_CODE(CL_OUT_OF_RESOURCES),
    WEFT_CODE(CL_OUT_OF_HOST_MEMORY),
    WEFT_CODE(CL_PROFILING_INFO_NOT_AVAILABLE),
    WEFT_CODE(CL_BUILD_PROGRAM_FAILURE),
    WEFT_CODE(CL_MAP_FAILURE),
    WEFT_CODE(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST),
    WEFT_CODE(CL_DEVICE_PARTITION_FAILED),
    WEFT_CODE(CL_INVALID_VALUE),
    WEFT_CODE(CL_INVALID_DEVICE),
    WEFT_CODE(CL_INVALID_CONTEXT),
    WEFT_CODE(CL_INVALID_QUEUE_PROPERTIES),
    WEFT_CODE(CL_INVALID_COMMAND_QUEUE),
    WEFT_CODE(CL_INVALID_HOST_PTR),
    WEFT_CODE(CL_INVALID_MEM_OBJECT),
    WEFT_CODE(CL_INVALID_BINARY),
    WEFT_CODE(CL_INVALID_BUILD_OPTIONS),
    WEFT_CODE(CL_INVALID_PROGRAM),
    WEFT_CODE(CL_INVALID_PROGRAM_EXECUTABLE),
    WEFT_CODE(CL_INVALID_KERNEL_NAME),
    WEFT_CODE(CL_INVALID_KERNEL),
    WEFT_CODE(CL_INVALID_ARG_INDEX),
    WEFT_CODE(CL_INVALID_ARG_VALUE),
    WEFT_CODE(CL_INVALID_ARG_SIZE),
    WEFT_CODE(CL_INVALID_KERNEL_ARGS),
    WEFT_CODE(CL_INVALID_WORK_GROUP_SIZE),
    WEFT_CODE(CL_INVALID_EVENT_WAIT_LIST),
    WEFT_CODE(CL_INVALID_EVENT),
    WEFT_CODE(CL_INVALID_OPERATION),
    WEFT_CODE(CL_INVALID_BUFFER_SIZE),
    WEFT_CODE(CL_INVALID_DEVICE_PARTITION_COUNT),
    {-1001, "CL_PLATFORM_NOT_FOUND_KHR"},
};
#undef WEFT_CODE

}  // namespace

std::string opencl_code_name(cl_int code) {
    const auto* known = std::find_if(std::begin(kCodes), std::end(kCodes),
                                     [&](const CodeName& entry) { return entry.code == code; });
    return known == std::end(kCodes) ? "code " + std::to_string(code) : known->name;
}

RunError opencl_error(const std::string& where, const cl::Error& error) {
    return RunError(where + ": " + error.what() + " failed with " + opencl_code_name(error.err()));
}

}  // namespace weft
