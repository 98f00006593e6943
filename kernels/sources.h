#pragma once

#include <span>
#include <string_view>

namespace weft::kernels {

/// The text of one kernel header, embedded at build time.
struct SourceFile {
    std::string_view path;  ///< from the project's root: "kernels/xpbd/springs.h"
    std::string_view text;
};

/// Every header that OpenCL may need.
std::span<const SourceFile> source_files();

}  // namespace weft::kernels
