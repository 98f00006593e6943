#include "apps/weft/command_line/typed_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace weft {
namespace {

std::string& noted_command_line() {
    static std::string line;
    return line;
}

}  // namespace

void note_command_line(int argc, char** argv) {
    noted_command_line() = fmt::format("{}", fmt::join(argv, argv + argc, " "));
}

const std::string& command_line() { return noted_command_line(); }

}  // namespace weft
