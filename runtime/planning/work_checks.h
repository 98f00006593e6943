#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "runtime/planning/work.h"

namespace weft {

/// What would otherwise fail later and elsewhere, or give wrong results without a word: buffers
/// that are gone, strip tables that are none, kinds without names, and tasks that do not say what
/// their kernels read and write. Throws Misuse.
void check_work(Work& work, std::size_t devices);

/// The buffers that kernels of some work use, their sizes when it was checked, and what its strip
/// tables said: plans are made from these, so they have to stay as they are while a runner runs on
/// them. Tables' columns, which are resized, are left out.
class KnownBuffers {
public:
    explicit KnownBuffers(Work& work);
    /// Throws Misuse for a buffer that was resized since, and for a strip table with other values.
    void check() const;

private:
    void add_size(const BufferStorage& buffer);
    void add_strips(const TaskBody& body, const Segments& strips);

    struct Strips {
        Segments table;
        std::string body;  ///< one that runs on them
        std::vector<int> values;
    };
    std::vector<std::pair<const BufferStorage*, int>> generations_;
    std::vector<Strips> strips_;
};

}  // namespace weft
