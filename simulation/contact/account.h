#pragma once

#include <string>
#include <vector>

#include "runtime/launch.h"
#include "runtime/step.h"
#include "runtime/trace/records.h"
#include "simulation/model/model.h"

namespace weft {

/// What contact tells of a frame: how near vertices came to a surface, and whom it took back.
class ContactAccount {
public:
    /// range: up to where surfaces touch [m]
    ContactAccount(const Model& model, float range);

    /// At a substep's end.
    /// cut      [vertices] whom the last truncation took back
    /// anchors  [vertices] where they were when contacts were looked for
    /// goals    [vertices] where inertia would lead them
    void add_launch(std::vector<Launch>& launches, Buffer<int>& cut, Buffer<float4>& anchors,
                    Buffer<float4>& goals);
    void add_accesses(Step::Adding& task, int first, int last);

    /// [vertices] how near a surface each came [m]; who fills the rows of contacts writes it.
    Buffer<float>& nearest() { return nearest_; }
    /// [2 * vertices] in how many substeps each was taken back, and had no place to go to.
    Buffer<int>& cut_counts() { return cut_counts_; }
    /// All that the host needs for what comes now.
    std::vector<BufferStorage*> buffers() { return {&cut_counts_, &cut_ways_, &nearest_}; }

    /// What is to be told; empty: nothing.
    std::string trouble() const;
    /// What there was to do, but for numbers of pairs and rows.
    ContactRecord record() const;
    /// With how many substeps inertia would lead nobody so far that it is taken back.
    int substeps_wanted() const;

private:
    const Model& model_;
    float range_;
    Buffer<float> nearest_;
    Buffer<int> cut_counts_;
    Buffer<float> cut_ways_;
};

}  // namespace weft
