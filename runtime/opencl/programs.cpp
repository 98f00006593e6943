#include "runtime/opencl/programs.h"

#include <filesystem>

#include "runtime/error.h"
#include "runtime/io/cache_folder.h"

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

std::string driver_of(const cl::Device& device) {
    const cl::Platform platform(device.getInfo<CL_DEVICE_PLATFORM>());
    return platform.getInfo<CL_PLATFORM_VERSION>() + '\n' + device.getInfo<CL_DEVICE_NAME>() +
           '\n' + device.getInfo<CL_DRIVER_VERSION>();
}

void keep_binary(const cl::Program& program, const fs::path& path) {
    const auto binaries = program.getInfo<CL_PROGRAM_BINARIES>();
    if (binaries.empty() || binaries.front().empty()) return;
    const auto& binary = binaries.front();
    write_cached(path, {reinterpret_cast<const char*>(binary.data()), binary.size()});
}

}  // namespace

Programs::Programs(const cl::Context& context, const cl::Device& device,
                   const BuildOptions& options)
    : context_(context),
      device_(device),
      flags_(build_flags(device, options)),
      keep_binaries_(options.keep_binaries),
      driver_(driver_of(device)) {}

/// A program without devices if the bytes are none that this driver takes.
cl::Program Programs::from_disk(const std::string& bytes) const {
    if (bytes.empty()) return {};
    try {
        cl::Program program(context_, {device_},
                            cl::Program::Binaries{{bytes.begin(), bytes.end()}});
        program.build(device_, flags_.c_str());
        return program;
    } catch (const cl::Error&) {
        return {};  // made by another driver, or damaged: build it anew
    }
}

cl::Program Programs::build(const std::string& text) const {
    cl::Program program(context_, text);
    try {
        program.build(device_, flags_.c_str());
    } catch (const cl::Error& error) {
        throw RunError(
            opencl_error("building kernels for " + device_.getInfo<CL_DEVICE_NAME>(), error)
                .what() +
            std::string("\n") + program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device_));
    }
    return program;
}

cl::Program Programs::make(const std::string& text) const {
    const fs::path folder = keep_binaries_ ? cache_folder() : fs::path();
    if (folder.empty()) return build(text);
    const fs::path path = folder / (cache_key(driver_ + '\n' + flags_ + '\n' + text) + ".bin");
    if (cl::Program kept = from_disk(read_cached(path)); kept() != nullptr) return kept;
    cl::Program program = build(text);
    keep_binary(program, path);
    return program;
}

const cl::Program& Programs::program(const EntryPoints& points) {
    const std::lock_guard lock(mutex_);
    auto known = made_.find(points);
    if (known == made_.end()) known = made_.emplace(points, make(program_text(points))).first;
    return known->second;
}

}  // namespace weft
