#pragma once

#include <vector>

#include "simulation/contact/frozen.h"
#include "simulation/contact/rows.h"
#include "simulation/model/model.h"

namespace weft {

/// The slips that friction holds from substep to substep (kernels/contact/sticking.h).
class Sticking {
public:
    /// rows: have_slips(), and outlive this
    Sticking(Model& model, const ContactRows& rows, Rubbing rubbing);

    /// Where a substep's contacts are known: with which slips they begin.
    /// anchors  [vertices] where they were found; whoever launches it reads them all
    void add_recall(std::vector<Launch>& launches, Buffer<float4>& anchors);
    void add_recall_accesses(Step::Adding& task);
    /// Behind all that moves vertices in a substep: what stays of them. Reads all positions, and
    /// rows.
    void add_keep(std::vector<Launch>& launches);
    void add_keep_accesses(Step::Adding& task, int first, int last);

    /// [3 * vertices] what a simulation carries from frame to frame
    Buffer<float4>& kept() { return kept_; }

private:
    Model& model_;
    ContactRows rows_;
    float creep_;
    Buffer<float4> kept_;
};

}  // namespace weft
