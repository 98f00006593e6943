#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace weft {

/// What the request says of a run that is in the folder already.
enum class EarlierOutput { kKeep, kResume, kReplace };

/// The folder that a run writes into. It belongs to one run at a time.
class OutputFolder {
public:
    /// Looks, and touches nothing yet, so that a wrong request leaves no trace. Throws UserError if
    /// a run is there that is not to be replaced (a finished one, unless it is to go on, or, if it
    /// is to be kept, one that has left a checkpoint to go on from), or if the folder cannot be
    /// made or written.
    OutputFolder(std::filesystem::path path, EarlierOutput earlier);
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    /// Makes the folder, and takes away the files of the run before. Throws UserError, also if
    /// another run writes there.
    void claim();
    /// To go on from the run before: moves those of its outputs (trace(), geometry()) aside
    /// (before()) that are written anew. The others stay what they are. Throws UserError likewise.
    void claim_to_go_on(const std::vector<std::filesystem::path>& outputs);
    /// Takes away what was moved aside.
    void forget_before();
    /// Where a file of the run before is while it is being taken over.
    static std::filesystem::path before(const std::filesystem::path& file);

    bool has_finished() const;
    [[noreturn]] void refuse_finished() const;
    bool replaces_unfinished() const { return replaces_unfinished_; }
    /// Name of the scene whose unfinished run claim() would take away; empty: none, or not known.
    std::string unfinished_scene() const;
    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path trace() const { return path_ / "trace.h5"; }
    std::filesystem::path geometry() const { return path_ / "frames.vtkhdf"; }
    std::filesystem::path summary() const { return path_ / "summary.json"; }
    std::filesystem::path checkpoint() const { return path_ / "checkpoint"; }

private:
    void refuse_to_replace(EarlierOutput earlier) const;
    void open();
    void lock();
    void remove(const std::filesystem::path& old) const;
    void rename(const std::filesystem::path& from, const std::filesystem::path& to) const;
    void set_aside(const std::filesystem::path& file) const;
    void bring_back(const std::filesystem::path& file) const;

    std::filesystem::path path_;
    bool replaces_unfinished_ = false;
    int descriptor_ = -1;
};

}  // namespace weft
