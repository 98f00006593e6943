#include <filesystem>
#include <vector>

#include "runtime/io/cache_folder.h"
#include "runtime/opencl/program.h"

namespace weft {

namespace {

namespace fs = std::filesystem;

std::string build_flags(const cl::Device& device, const BuildOptions& options) {
    std::string flags = "-cl-std=CL1.2 -DWEFT_LANES=" + std::to_string(options.lanes);
    if (!options.strict) return flags + " -DWEFT_FAST_MATH -cl-fast-relaxed-math";
    const auto single = device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>();
    if ((single & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0) {
        flags += " -cl-fp32-correctly-rounded-divide-sqrt";
    }
    return flags;
}

fs::path cached_file(const cl::Device& device, const std::string& flags, const std::string& text) {
    const fs::path folder = cache_folder();
    if (folder.empty()) return {};
    const cl::Platform platform(device.getInfo<CL_DEVICE_PLATFORM>());
    const std::string key = platform.getInfo<CL_PLATFORM_VERSION>() + '\n' +
                            device.getInfo<CL_DEVICE_NAME>() + '\n' +
                            device.getInfo<CL_DRIVER_VERSION>() + '\n' + flags + '\n' + text;
    return folder / (cache_key(key) + ".bin");
}

/// A program from the cached binary; one without devices if that does not work.
cl::Program from_cache(const cl::Context& context, const cl::Device& device, const fs::path& path,
                       const std::string& flags) {
    const std::string bytes = path.empty() ? std::string{} : read_cached(path);
    if (bytes.empty()) return {};
    try {
        cl::Program program(context, {device}, cl::Program::Binaries{{bytes.begin(), bytes.end()}});
        program.build(device, flags.c_str());
        return program;
    } catch (const cl::Error&) {
        return {};  // made by another driver, or damaged: build it anew
    }
}

}  // namespace

cl::Program build_program(const cl::Context& context, const cl::Device& device,
                          const std::string& text, const BuildOptions& options) {
    const std::string flags = build_flags(device, options);
    const fs::path path = cached_file(device, flags, text);
    if (cl::Program cached = from_cache(context, device, path, flags); cached() != nullptr) {
        return cached;
    }
    cl::Program program(context, text);
    try {
        program.build(device, flags.c_str());
    } catch (const cl::Error& error) {
        throw RunError(
            opencl_error("building kernels for " + device.getInfo<CL_DEVICE_NAME>(), error).what() +
            std::string("\n") + program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device));
    }
    if (!path.empty()) {
        const auto binaries = program.getInfo<CL_PROGRAM_BINARIES>();
        if (!binaries.empty() && !binaries.front().empty()) {
            const auto& binary = binaries.front();
            write_cached(path, {reinterpret_cast<const char*>(binary.data()), binary.size()});
        }
    }
    return program;
}

}  // namespace weft
