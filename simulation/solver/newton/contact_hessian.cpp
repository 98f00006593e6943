#include "simulation/solver/newton/contact_hessian.h"

#include "kernels/newton/contacts.h"

namespace weft {

ContactHessian::ContactHessian(Model& model, ContactResponse& contact)
    : model_(model),
      rows_(contact.rows()),
      rubbing_(contact.rubbing()),
      curvatures_(rows_.table.add_column<float>("curvatures")),
      grips_(rows_.table.add_column<float>("grips")) {}

Launch ContactHessian::couple() {
    return launch(kernels::couple_contacts, model_.vertices(), *model_.positions,
                  rows_.table.rows(), rows_.table.counts(), rows_.corner0, rows_.corner1,
                  rows_.corner2, rows_.corner3, rows_.normals, rows_.weights, rows_.measures,
                  rows_.slips, curvatures_, grips_, static_cast<float>(rubbing_.friction),
                  static_cast<float>(rubbing_.creep));
}

void ContactHessian::add_row_reads(Step::Adding& task, int first_strip, int end_strip) {
    rows_.add_reads(task, first_strip, end_strip, model_.vertices().item(first_strip),
                    model_.vertices().item(end_strip));
}

void ContactHessian::add_couple_accesses(Step::Adding& task, int first_strip, int end_strip) {
    add_row_reads(task, first_strip, end_strip);
    task.updates(curvatures_, rows_.table.entries()).updates(grips_, rows_.table.entries());
}

Launch ContactHessian::multiply(Buffer<float4>& directions, Buffer<float>& products) {
    return launch(kernels::multiply_contacts, model_.vertices(), directions, rows_.table.rows(),
                  rows_.table.counts(), rows_.corner0, rows_.corner1, rows_.corner2, rows_.corner3,
                  rows_.normals, rows_.weights, rows_.measures, curvatures_, grips_, products,
                  model_.vertex_count());
}

void ContactHessian::add_multiply_accesses(Step::Adding& task, int first_strip, int end_strip) {
    add_row_reads(task, first_strip, end_strip);
    task.reads(curvatures_, rows_.table.entries(), first_strip, end_strip)
        .reads(grips_, rows_.table.entries(), first_strip, end_strip);
}

}  // namespace weft
