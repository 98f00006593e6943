#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "runtime/step.h"
#include "simulation/model/model.h"
#include "simulation/solver/regions.h"

namespace weft {

/// How substeps begin and end in all methods that descend E(x); see kernels/descent/substep.h.
class DescentSubstep {
public:
    explicit DescentSubstep(Model& model);

    /// What the first and the last task of a substep launch.
    std::vector<Launch> begin();
    std::vector<Launch> end();
    void add_begin(Step& step, const TaskBody& body, const Region& region);
    Step::Adding add_end(Step& step, const TaskBody& body, const Region& region, int iteration);

    /// Pushes vertices out of obstacles, as the last thing of an iteration; nothing without any.
    void add_contacts(std::vector<Launch>& launches, Buffer<float4>& positions);
    /// What that needs of vertices [first, last), besides the positions.
    void add_contact_accesses(Step::Adding& task, int first, int last);

    /// [vertices] x~; between substeps x - x~, which the next one starts from.
    Buffer<float4>& targets() { return targets_; }

    /// The vertices of strips [first_strip, end_strip).
    std::pair<int, int> vertices(int first_strip, int end_strip) const;

private:
    Model& model_;
    Buffer<float4> targets_;
    std::unique_ptr<Buffer<float4>> pushed_;  ///< null: no obstacles
};

/// How far the elements of vertices reach.
class Reach {
public:
    explicit Reach(const Model& model);

    /// The range of vertices that share an element with one of [begin, end), and those themselves.
    std::pair<int, int> around(int begin, int end) const;

private:
    std::vector<int> lowest_, highest_;  ///< [vertices] that share an element with it
};

}  // namespace weft
