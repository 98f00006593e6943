#pragma once

#include <span>
#include <string>
#include <vector>

#include "runtime/launch.h"
#include "runtime/opencl/api.h"

namespace weft {

/// How kernels are turned into entry points.
enum class EntryStyle {
    kPerStrip,   ///< one work-item runs a task's whole body on one strip: for CPU devices
    kPerColour,  ///< one work-item per item, one launch per kernel and colour: for GPUs
};

struct ProgramText {
    std::string text;
    /// [body] names of its entry points: one (per strip), or one per launch (per colour). Bodies
    /// and launches that do the same with other arguments share them: building a kernel takes a
    /// driver seconds.
    std::vector<std::vector<std::string>> entries;
};

/// OpenCL C for all kernels that the bodies launch, and the entry points that loop over their
/// items. Nothing else is in it: a kernel that no body names is not compiled.
ProgramText program_text(std::span<const TaskBody* const> bodies, EntryStyle style);

struct BuildOptions {
    int lanes = 1;
    bool strict = true;
};

/// Builds a program, or takes its binary from the cache folder on disk ($WEFT_CACHE_DIR, else weft
/// below $XDG_CACHE_HOME or ~/.cache). A cache that cannot be used is passed over. Throws RunError
/// with the build log.
cl::Program build_program(const cl::Context& context, const cl::Device& device,
                          const std::string& text, const BuildOptions& options);

}  // namespace weft
