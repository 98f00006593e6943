#pragma once

#include <string>

namespace weft {

/// What the user typed, words joined by blanks; for traces. run_program() notes it.
void note_command_line(int argc, char** argv);
const std::string& command_line();

}  // namespace weft
