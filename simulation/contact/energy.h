#pragma once

#include <vector>

#include "runtime/planning/regions.h"
#include "simulation/contact/rows.h"
#include "simulation/contact/sticking.h"
#include "simulation/model/model.h"

namespace weft {

/// What contacts have stored [J].
struct StoredInContacts {
    double start = 0.0;  ///< where a frame began, by the contacts that its first substep found
    double end = 0.0;    ///< where it ended, by those of its last substep
};

/// The energy of contacts, as they were found at a substep's begin (kernels/contact/terms.h).
class ContactEnergy {
public:
    /// sticking: what is kept of slips in the same task; may be none. kind: of the task
    ContactEnergy(Model& model, const ContactRows& rows, Sticking* sticking, int kind);

    /// Lets what rises off its contacts do so without their help, in the same task
    /// (kernels/contact/rising.h). targets: [vertices] x - x~, which the next substep starts from
    void let_rise(Buffer<float4>& targets);

    const TaskBody& body() const { return body_; }
    /// Behind all that moves vertices in a substep: what measures it.
    void add(Step& step, const std::vector<Region>& regions, int iteration);
    /// [2 * vertices] what the frame has measured
    Buffer<float>& energies() { return energies_; }
    /// Of all contacts; the host has energies().
    StoredInContacts stored() const;

    /// The contacts' terms of E at these positions, over all vertices; slots: [vertices].
    Launch terms(Buffer<float4>& positions, Buffer<int>& slots, Buffer<float>& terms);
    /// What that needs of strips [first_strip, end_strip), besides the positions of all vertices.
    void add_terms_accesses(Step::Adding& task, int first_strip, int end_strip) const;

private:
    double sum_of(int column) const;

    Model& model_;
    ContactRows rows_;
    Sticking* sticking_;
    Buffer<float4>* targets_ = nullptr;  ///< null: nothing starts from those of the substep before
    Buffer<float> energies_;
    TaskBody body_;
};

}  // namespace weft
