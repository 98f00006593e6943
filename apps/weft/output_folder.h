#pragma once

#include <filesystem>
#include <string>

namespace weft {

/// The folder that a run writes into. It belongs to one run at a time.
class OutputFolder {
public:
    /// Looks, and touches nothing yet, so that a wrong request leaves no trace. Throws UserError if
    /// a finished run is there (unless `force`), or if the folder cannot be made or written.
    OutputFolder(std::filesystem::path path, bool force);
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    /// Makes the folder, and takes away the files of the run before; or, to go on from them, moves
    /// its trace and geometry aside (before()). Throws UserError, also if another run that goes on
    /// writes there.
    void claim(bool resume);
    /// Takes away what was moved aside.
    void forget_before();
    /// Where a file of the run before is while it is being taken over.
    static std::filesystem::path before(const std::filesystem::path& file);

    bool replaces_unfinished() const { return replaces_unfinished_; }
    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path trace() const { return path_ / "trace.h5"; }
    std::filesystem::path geometry() const { return path_ / "frames.vtkhdf"; }
    std::filesystem::path summary() const { return path_ / "summary.json"; }
    std::filesystem::path checkpoint() const { return path_ / "checkpoint"; }

private:
    void lock();
    void remove(const std::filesystem::path& old) const;
    void set_aside(const std::filesystem::path& file) const;

    std::filesystem::path path_;
    bool replaces_unfinished_ = false;
    int descriptor_ = -1;
};

}  // namespace weft
