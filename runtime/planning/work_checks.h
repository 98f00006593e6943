#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "runtime/planning/work.h"

namespace weft {

/// What would otherwise fail later and elsewhere, or give wrong results without a word: buffers
/// that are gone, strip tables that are none, kinds without names, and tasks that do not say what
/// their kernels read and write. Throws Misuse.
void check_work(Work& work, std::size_t devices);

/// The buffers that kernels of some work use, and their sizes when it was checked: they have to
/// stay as they are while a runner runs on them. Tables' columns, which do not, are left out.
class KnownSizes {
public:
    explicit KnownSizes(Work& work);
    /// Throws Misuse for a buffer that was resized since.
    void check() const;

private:
    std::vector<std::pair<const BufferStorage*, int>> generations_;
};

}  // namespace weft
