#pragma once

#include <vector>

#include "simulation/contact/response.h"

namespace weft {

/// Contacts as constraints of XPBD (kernels/xpbd/contacts.h). In each iteration the elements lead
/// vertices anywhere, which is shown to all; then contacts push, all at once.
class ContactProjection {
public:
    ContactProjection(Model& model, ContactResponse& contact);

    /// Behind the elements.
    void add_snapshot(std::vector<Launch>& launches);
    void add_snapshot_accesses(Step::Adding& task, int iteration, int first_strip, int end_strip);

    /// In a task of its own behind that, over strips [first_strip, end_strip): contacts push, and
    /// rub where there is friction.
    void add_project(std::vector<Launch>& launches);
    void add_project_accesses(Step::Adding& task, int iteration, int first_strip, int end_strip);

    /// [entries of the contacts' rows] how hard each presses, times h^2 [N s^2]
    Buffer<float>& multipliers() { return multipliers_; }

private:
    Launch share(int ahead);
    Launch push();
    Launch rub();

    Model& model_;
    ContactRows rows_;
    Buffer<float4>& snapshots_;  ///< [2 * vertices] the contacts'
    Buffer<float>& least_;       ///< [vertices] likewise
    Rubbing rubbing_;
    Buffer<float>& multipliers_;  ///< [entries of the rows]
    Buffer<float4>* rubs_;        ///< likewise; null: no friction
};

}  // namespace weft
