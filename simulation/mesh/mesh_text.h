#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "simulation/mesh/vec3.h"

/// Reading mesh files as text, word by word, with the line for messages.
namespace weft {

/// Rest positions beyond this have steps of more than a tenth of a metre in single precision [m].
constexpr double kMaxCoordinate = 1e6;

/// The whole file. Throws UserError where it is missing, unreadable or empty.
/// what  "an OBJ mesh": what was expected
std::string read_mesh_text(const std::string& path, const std::string& what);

/// For messages: printable and short.
std::string quoted(std::string_view word);

/// Takes the next word off the front of a line; empty at its end.
std::string_view next_word(std::string_view& rest);

/// A text as a stream of words.
class MeshWords {
public:
    /// Both outlive the reader. path: for messages
    MeshWords(std::string_view text, const std::string& path) : rest_(text), path_(path) {}

    bool at_end();
    /// The rest of the line that the last word is in.
    std::string_view rest_of_line();
    /// A whole line, without spaces at its ends.
    std::string_view next_line();
    /// The next word, or a failure that says what was expected.
    std::string_view word(std::string_view expected);
    std::int64_t integer(std::string_view expected);
    double number(std::string_view expected);
    /// A count of things that take at least `bytes` each in the rest of the text: more than fit are
    /// a failure, so that nobody reserves memory for them.
    std::size_t count(std::string_view expected, std::size_t bytes);
    /// Finite, and within kMaxCoordinate.
    Vec3 position();

    [[noreturn]] void fail(const std::string& what) const;

private:
    void skip_space();

    std::string_view rest_;
    const std::string& path_;
    std::size_t line_ = 1;
};

}  // namespace weft
