#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "runtime/opencl/program.h"

namespace weft {

namespace {

namespace fs = std::filesystem;

/// Empty where there is no place for a cache.
fs::path cache_folder() {
    if (const char* own = std::getenv("WEFT_CACHE_DIR")) return own;
    if (const char* xdg = std::getenv("XDG_CACHE_HOME")) return fs::path(xdg) / "weft";
    if (const char* home = std::getenv("HOME")) return fs::path(home) / ".cache" / "weft";
    return {};
}

std::uint64_t fnv1a(const std::string& text) {
    std::uint64_t hash = 14695981039346656037ULL;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
    return hash;
}

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
    char name[32];
    std::snprintf(name, sizeof name, "%016llx.bin", static_cast<unsigned long long>(fnv1a(key)));
    return folder / name;
}

std::vector<unsigned char> read_file(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Whole or not at all: other processes may read the same file.
void write_file(const fs::path& path, const std::vector<unsigned char>& bytes) {
    std::error_code ignored;
    fs::create_directories(path.parent_path(), ignored);
    const fs::path part = path.string() + "." + std::to_string(::getpid());
    {
        std::ofstream out(part, std::ios::binary);
        out.write(reinterpret_cast<const char*>(bytes.data()),
                  static_cast<std::streamsize>(bytes.size()));
        if (!out.flush()) {
            fs::remove(part, ignored);
            return;
        }
    }
    fs::rename(part, path, ignored);
    if (ignored) fs::remove(part, ignored);
}

/// A program from the cached binary; one without devices if that does not work.
cl::Program from_cache(const cl::Context& context, const cl::Device& device, const fs::path& path,
                       const std::string& flags) {
    const auto bytes = path.empty() ? std::vector<unsigned char>{} : read_file(path);
    if (bytes.empty()) return {};
    try {
        cl::Program program(context, {device}, cl::Program::Binaries{bytes});
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
        if (!binaries.empty() && !binaries.front().empty()) write_file(path, binaries.front());
    }
    return program;
}

}  // namespace weft
