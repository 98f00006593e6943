#pragma once

#include <span>
#include <string>
#include <vector>

#include "runtime/launch.h"
#include "runtime/opencl/api.h"
#include "runtime/opencl/entry_style.h"

namespace weft {

/// How a device wants its entry points.
struct EntryOptions {
    EntryStyle style = EntryStyle::kPerStrip;
    int group_size = 1;               ///< work-items of a group (kPerGroup)
    std::size_t most_parameters = 0;  ///< [bytes] of an entry point (kPerGroup)
};

/// One entry point (per strip or group), or one per launch (per colour).
struct BodyEntries {
    EntryStyle style;  ///< per colour where a body has more parameters than a group's may have
    std::vector<std::string> names;
};

struct ProgramText {
    std::string text;
    /// [body] Bodies and launches that do the same with other arguments share entry points:
    /// building a kernel takes a driver seconds.
    std::vector<BodyEntries> entries;
};

/// OpenCL C for all kernels that the bodies launch, and the entry points that loop over their
/// items. Nothing else is in it: a kernel that no body names is not compiled.
ProgramText program_text(std::span<const TaskBody* const> bodies, const EntryOptions& options);

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
