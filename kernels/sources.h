#pragma once

#include <span>
#include <string_view>

namespace weft::kernels {

/// The text of one kernel header, embedded at build time.
struct SourceFile {
    std::string_view path;  ///< "kernels/xpbd/springs.h"; of others' headers the whole path
    std::string_view text;
};

/// Every header that OpenCL may need, ordered by path.
std::span<const SourceFile> source_files();

/// The header that a compiler calls by this path. Compilers name one and the same header in
/// several ways, so what counts is how much of the paths' ends agrees. Null: none of that name.
const SourceFile* find_source(std::string_view path);
/// The header that an #include names; null if there is none.
const SourceFile* find_included(std::string_view name);

/// The headers of the language itself. Made by CMake.
std::span<const SourceFile> language_sources();
/// Adds headers, whose text lives as long as the program.
bool add_sources(std::span<const SourceFile> files);

}  // namespace weft::kernels
