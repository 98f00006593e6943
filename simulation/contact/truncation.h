#pragma once

#include <vector>

#include "runtime/launch.h"
#include "runtime/row_table.h"
#include "runtime/step.h"
#include "simulation/model/model.h"

namespace weft {

/// Takes vertices back behind planes and into balls, so that nothing passes through a surface
/// whatever a solver does (kernels/contact/truncation.h).
class ContactTruncation {
public:
    /// room      of a row of planes, at the beginning
    /// floor     the least distance that contact leaves between surfaces [m]
    /// anchors   [vertices] where contacts were looked for, and how far each may go from there
    /// touching  [strips] 0: no vertex of the strip has a row
    ContactTruncation(Model& model, int room, float floor, Buffer<float4>& anchors,
                      Buffer<int>& touching);

    /// Of a substep's start, behind what finds the planes. slack: that it leaves before these [m]
    void add_start(std::vector<Launch>& launches, float slack);
    /// all_from: the iteration from which on it is done with vertices that have no pairs, too
    void add(std::vector<Launch>& launches, Buffer<float4>& positions, int all_from);
    /// What both need of their own strips. Of scenes without planes nobody asks.
    void add_accesses(Step::Adding& task, StripRange strips);
    /// What reading a strip's planes takes.
    void add_reads(Step::Adding& task, StripRange strips);

    /// That are written by who finds them: a row of planes per vertex,
    RowTable& table() { return table_; }
    Buffer<float4>& planes() { return planes_; }
    /// [vertices] how far each is from them [m]; WEFT_NO_PLANE where it has no pairs,
    Buffer<float>& least() { return least_; }
    /// [vertices] where contacts were looked for, and how far each may go from there [m].
    Buffer<float4>& anchors() { return anchors_; }
    /// [strips] where nothing but balls holds vertices: 1; else 0.
    Buffer<int>& apart() { return apart_; }
    /// [vertices] whom the last truncation took back: not 0.
    Buffer<int>& cut() { return cut_; }
    /// What each truncation but that of the start leaves before planes [m].
    float slack() const { return soft_; }

private:
    Launch behind_planes(Buffer<float4>& positions, float soft, int all_from);
    Launch in_balls(Buffer<float4>& positions, int all_from);

    Model& model_;
    float soft_, hard_;  ///< slack before planes, and what is left of it where there is less [m]
    Buffer<float4>& anchors_;
    Buffer<int>& touching_;
    Buffer<int> apart_;
    RowTable table_;
    Buffer<float4>& planes_;
    Buffer<float> least_;
    Buffer<int> cut_;
};

}  // namespace weft
