#pragma once

#include <vector>

#include "runtime/buffer.h"
#include "simulation/mesh/vec3.h"

namespace weft {

/// Which bodies belong together in each substep of a frame, for kernels/contact/bodies.h: a guess
/// at what will touch, that costs nothing but speed of convergence where it is wrong. There are
/// groups, their halves, the halves of these, ... (kernels/contact/groups.h); halves are what is on
/// both sides of the middle of a longest side.
class BodyGroups {
public:
    /// parts: of each body those of the scene's bodies that it has vertices of
    BodyGroups(int substeps, std::vector<std::vector<int>> parts);

    /// groups: [scene's bodies] of each the lowest number in its group; centres: [scene's bodies]
    /// [m]
    void place(int substep, std::vector<int> groups, const std::vector<Vec3>& centres);
    int body_count() const { return static_cast<int>(parts_.size()); }
    /// From 16 bodies on as many as make parts of four to seven of them, up to a limit.
    int level_count() const { return level_count_; }
    std::vector<BufferStorage*> buffers() { return {&firsts, &counts, &members, &leaders}; }

private:
    using Lists = std::vector<std::vector<int>>;
    /// The groups, of free bodies in their order.
    Lists listed(std::vector<int> groups) const;
    Lists halved(const Lists& groups, const std::vector<Vec3>& centres) const;
    void write(int table, const Lists& groups);

    std::vector<std::vector<int>> parts_;
    int level_count_;

public:
    /// [substeps * level_count * bodies] see the kernels
    Buffer<int> firsts, counts, members, leaders;
};

}  // namespace weft
