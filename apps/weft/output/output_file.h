#pragma once

#include <filesystem>
#include <string_view>

#include "runtime/io/whole_file.h"

namespace weft {

/// A file where the user wants one. Throws UserError if the place cannot be written.
WholeFile open_output(const std::filesystem::path& path);

/// All of it at once. Throws UserError as above, and RunError, e.g. when the disk is full.
void write_output(const std::filesystem::path& path, std::string_view content);

/// The folder of --out, made where it is not there. Throws UserError.
std::filesystem::path make_output_folder(const std::filesystem::path& folder);

}  // namespace weft
