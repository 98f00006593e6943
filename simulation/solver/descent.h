#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "runtime/planning/regions.h"
#include "runtime/step.h"
#include "simulation/contact/response.h"
#include "simulation/model/model.h"
#include "simulation/solver/body_momentum.h"

namespace weft {

/// How substeps begin and end in all methods that descend E(x); see kernels/descent/substep.h.
class DescentSubstep {
public:
    /// first_kind: of tasks that are not the solver's own, if there are any
    DescentSubstep(Model& model, int first_kind);

    /// What the first and the last task of a substep launch.
    std::vector<Launch> begin();
    std::vector<Launch> end();
    Step::Adding add_begin(Step& step, const TaskBody& body, const Region& region);
    Step::Adding add_end(Step& step, const TaskBody& body, const Region& region, int iteration);
    /// Behind the ends of all regions: what is measured of a substep.
    void add_measurements(Step& step, const std::vector<Region>& regions, int iteration);

    /// Free bodies, and obstacles' pushes.
    BodyMomentum& momentum() { return momentum_; }

    /// What there is besides the solver's own: tasks for momentum, and for contacts.
    void list_bodies(std::vector<const TaskBody*>& bodies) const;
    void list_kinds(std::vector<std::string>& kinds) const;
    std::vector<RowTable*> tables();

    /// Contacts between bodies; null: none.
    ContactResponse* contact() { return contact_.get(); }

    /// [vertices] x~; between substeps x - x~, which the next one starts from.
    Buffer<float4>& targets() { return targets_; }
    /// See Solver::state().
    std::vector<BufferStorage*> state();

    /// The vertices of strips [first_strip, end_strip).
    std::pair<int, int> vertices(int first_strip, int end_strip) const;

private:
    Model& model_;
    Buffer<float4> targets_;
    std::unique_ptr<ContactResponse> contact_;
    BodyMomentum momentum_;
};

/// Which positions the elements of a range of vertices read.
class Halo {
public:
    explicit Halo(const Model& model);

    /// The range of vertices that share an element with one of [begin, end), and those themselves.
    std::pair<int, int> around(int begin, int end) const;

private:
    std::vector<int> lowest_, highest_;  ///< [vertices] that share an element with it
};

}  // namespace weft
