#include "apps/weft/output/output_file.h"

#include "runtime/error.h"

namespace weft {

WholeFile open_output(const std::filesystem::path& path) {
    try {
        return WholeFile(path);
    } catch (const RunError& error) {
        throw UserError(error.what());
    }
}

void write_output(const std::filesystem::path& path, std::string_view content) {
    WholeFile file = open_output(path);
    file.write(content);
    file.finish();
}

std::filesystem::path make_output_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw UserError("--out: cannot make " + folder.string() + ": " + error.message());
    return folder;
}

}  // namespace weft
