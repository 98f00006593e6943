#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

namespace weft {

/// The name under which a file is written before it is whole: <path>.part
std::filesystem::path unfinished(const std::filesystem::path& path);

/// A file that appears whole or not at all; a pipe or device of that name is written as it is.
/// Errors are RunError: "<path>: cannot write<what>: <the system's reason>".
class WholeFile {
public:
    /// kMany: several processes, of several machines, may write the file at once; the last one to
    /// finish wins. An unfinished one has a name that nobody else has.
    enum class Writers { kOne, kMany };

    /// what  for the messages: "" or " the summary"
    explicit WholeFile(std::filesystem::path path, std::string what = "",
                       Writers writers = Writers::kOne);
    /// Takes away what is not finished.
    ~WholeFile();
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;

    void write(std::string_view bytes);
    /// Gives the file its name; readers of an old file of that name keep theirs.
    void finish();

private:
    void open_own();
    void remove_part() const;
    [[noreturn]] void fail(int reason) const;

    std::filesystem::path path_, part_;
    std::string what_;
    std::FILE* file_ = nullptr;
};

void write_whole_file(const std::filesystem::path& path, std::string_view bytes,
                      const std::string& what = "");

}  // namespace weft
