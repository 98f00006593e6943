#pragma once

#include "simulation/contact/response.h"
#include "simulation/model/model.h"

namespace weft {

/// The contacts' part of the projected Hessian, row by row of contact/rows.h. See
/// kernels/newton/contacts.h.
class ContactHessian {
public:
    ContactHessian(Model& model, ContactResponse& contact);

    /// Makes it anew at the model's positions,
    Launch couple();
    void add_couple_accesses(Step::Adding& task, int first_strip, int end_strip);
    /// and products += H directions, over all vertices.
    Launch multiply(Buffer<float4>& directions, Buffer<float>& products);
    /// Besides the directions of all vertices.
    void add_multiply_accesses(Step::Adding& task, int first_strip, int end_strip);

private:
    void add_row_reads(Step::Adding& task, int first_strip, int end_strip);

    Model& model_;
    ContactRows rows_;
    Rubbing rubbing_;
    Buffer<float>&curvatures_, &grips_;
};

}  // namespace weft
