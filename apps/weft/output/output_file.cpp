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

}  // namespace weft
