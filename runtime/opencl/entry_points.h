#pragma once

#include <compare>
#include <string>
#include <vector>

#include "runtime/launch.h"
#include "runtime/opencl/entry_style.h"

namespace weft {

/// How a device wants its entry points.
struct EntryOptions {
    EntryStyle style = EntryStyle::kPerStrip;
    int group_size = 1;               ///< work-items of a group (kPerGroup)
    std::size_t most_parameters = 0;  ///< [bytes] of an entry point (kPerGroup)
};

/// What a body calls in OpenCL C: functions that loop over the items of its launches. Bodies that
/// do the same with other arguments have the same, whatever scene they belong to: building one
/// takes a driver seconds.
struct EntryPoints {
    EntryStyle style;  ///< per colour where a body has more parameters than a group's may have
    std::vector<std::string> names;  ///< one (per strip or group), or one per launch (per colour)
    std::string definitions;
    std::vector<std::string> files;  ///< the headers of the kernels that they call

    friend auto operator<=>(const EntryPoints&, const EntryPoints&) = default;
};

/// Throws Misuse for kernels that were not compiled for OpenCL.
EntryPoints entry_points(const TaskBody& body, const EntryOptions& options);

/// The text of their program: the kernels, what these include, and the entry points. Nothing else
/// is in it: a kernel that the body does not launch is not compiled.
std::string program_text(const EntryPoints& points);

}  // namespace weft
