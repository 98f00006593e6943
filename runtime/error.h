#pragma once

#include <stdexcept>
#include <string>

namespace weft {

/// The request was wrong: command line, scene, mesh, graph or trace. The program ends with exit
/// code 2. The message names the file, line and column or the field, the value, and what would be
/// right.
class UserError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A program uses the library in a way that cannot be: what was asked for would read or write where
/// nothing is, or mean nothing. The message says what, of which buffer, task or kernel.
class Misuse : public std::logic_error {
public:
    using std::logic_error::logic_error;
};

/// The run failed: diverged, disk full, a device lost with none left. Exit code 1.
class RunError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace weft
