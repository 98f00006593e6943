#pragma once

#include <vector>

#include "runtime/buffer.h"

namespace weft {

/// Which bodies belong together in each substep of a frame, for kernels/contact/bodies.h: a guess
/// at what will touch, that costs nothing but speed of convergence where it is wrong.
class BodyGroups {
public:
    /// parts: of each body those of the scene's bodies that it has vertices of
    BodyGroups(int substeps, std::vector<std::vector<int>> parts);

    /// groups: [scene's bodies] of each the lowest number in its group
    void place(int substep, std::vector<int> groups);
    int body_count() const { return static_cast<int>(parts_.size()); }
    std::vector<BufferStorage*> buffers() { return {&firsts, &counts, &members, &leaders}; }

private:
    std::vector<std::vector<int>> parts_;

public:
    Buffer<int> firsts, counts, members, leaders;  ///< [substeps * bodies] see the kernels
};

}  // namespace weft
