#pragma once

#include <stdexcept>
#include <string>

namespace weft {

/// Parses a command line, does what it says, and turns every exception into a message on stderr
/// and an exit code, which it returns.
int run_program(int argc, char** argv);

/// The program is to end with an exit code of its own, after one message. For what is neither a
/// mistake of the user nor a failure: work that goes on when the same command is given again.
class EndedEarly : public std::runtime_error {
public:
    EndedEarly(int exit_code, const std::string& message)
        : std::runtime_error(message), exit_code_(exit_code) {}
    int exit_code() const { return exit_code_; }

private:
    int exit_code_;
};

}  // namespace weft
