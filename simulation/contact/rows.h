#pragma once

#include <vector>

#include "runtime/row_table.h"
#include "runtime/step.h"
#include "simulation/topology/layout.h"

namespace weft {

/// The contacts of all vertices, a row each, as kernels/contact/rows.h has them.
struct ContactRows {
    RowTable& table;
    Buffer<int>&corner0, &corner1, &corner2, &corner3;
    Buffer<float4>&normals, &weights, &measures;
    Buffer<float4>& slips;  ///< without friction nobody reads them: `normals` stand in their place
    /// [strips] 0: no vertex of the strip has a row, or none of it and the next one (gates.h)
    Buffer<int>&touching, &meeting;

    bool have_slips() const { return &slips != &normals; }

    /// For launches over vertices of a phase that do nothing where there are no rows.
    Buffer<int>& gate(Phase phase) const { return phase == kSeamPhase ? meeting : touching; }

    /// What reading the rows of strips [first_strip, end_strip) takes, which have the vertices
    /// [first, last).
    void add_reads(Step::Adding& task, int first_strip, int end_strip, int first, int last) const;
    /// All of them, for Executor::fetch().
    std::vector<BufferStorage*> buffers() const;
};

}  // namespace weft
