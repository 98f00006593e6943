#pragma once

#include <map>
#include <mutex>
#include <string>

#include "runtime/opencl/api.h"
#include "runtime/opencl/entry_points.h"

namespace weft {

struct BuildOptions {
    int lanes = 1;
    bool strict = true;
    bool keep_binaries = true;  ///< on disk
};

/// A device's programs, one per task body, so that scenes and solvers share what they have in
/// common. Each is built once per process; binaries may be kept in the cache folder on disk
/// ($WEFT_CACHE_DIR, else weft below $XDG_CACHE_HOME or ~/.cache). A cache that cannot be used is
/// passed over. Safe to use from several threads.
class Programs {
public:
    Programs(const cl::Context& context, const cl::Device& device, const BuildOptions& options);

    /// The entry points' program. Throws RunError with the build log.
    const cl::Program& program(const EntryPoints& points);

private:
    cl::Program from_disk(const std::string& bytes) const;
    cl::Program build(const std::string& text) const;
    cl::Program make(const std::string& text) const;

    cl::Context context_;
    cl::Device device_;
    std::string flags_;
    bool keep_binaries_;
    std::string driver_;  ///< what binaries depend on beside their text
    std::mutex mutex_;
    std::map<EntryPoints, cl::Program> made_;
};

}  // namespace weft
