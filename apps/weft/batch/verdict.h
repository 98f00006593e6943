#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "apps/weft/batch/child_run.h"
#include "apps/weft/batch/run_folder.h"

namespace weft::batch {

/// The end of a log that still grows.
class LastWords {
public:
    /// Made before the run begins: what is there already was said by runs before.
    explicit LastWords(std::filesystem::path log);

    /// The error that was told last, or else the last line.
    std::string text() const;

private:
    std::filesystem::path log_;
    std::uintmax_t begin_;
};

/// What the end of a child says about its run.
struct Verdict {
    State state = State::kFinished;
    int exit_code = 0;  ///< of --index
    std::string why;
};

Verdict verdict_of(const ChildEnd& end, const LastWords& words);

}  // namespace weft::batch
