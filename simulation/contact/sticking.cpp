#include "simulation/contact/sticking.h"

#include "kernels/contact/sticking.h"

namespace weft {

Sticking::Sticking(Model& model, const ContactRows& rows, Rubbing rubbing)
    : model_(model),
      rows_(rows),
      creep_(static_cast<float>(rubbing.creep)),
      kept_("contact.kept_slips", 3 * model.positions->count()) {}

void Sticking::add_recall(std::vector<Launch>& launches, Buffer<float4>& anchors) {
    launches.push_back(launch(kernels::recall_slips, model_.vertices(), anchors, kept_,
                              rows_.table.rows(), rows_.table.counts(), rows_.corner0,
                              rows_.corner1, rows_.corner2, rows_.corner3, rows_.normals,
                              rows_.weights, rows_.measures, rows_.slips, model_.vertex_count()));
}

void Sticking::add_recall_accesses(Step::Adding& task) {
    task.reads(kept_, 0, 3 * model_.vertex_count()).updates(rows_.slips, rows_.table.entries());
}

void Sticking::add_keep(std::vector<Launch>& launches) {
    launches.push_back(launch(kernels::keep_slips, model_.vertices(), *model_.positions,
                              rows_.table.rows(), rows_.table.counts(), rows_.corner0,
                              rows_.corner1, rows_.corner2, rows_.corner3, rows_.normals,
                              rows_.weights, rows_.measures, rows_.slips, kept_,
                              model_.vertex_count(), creep_));
}

void Sticking::add_keep_accesses(Step::Adding& task, int first, int last) {
    const int all = model_.vertex_count();
    for (int column = 0; column < 3; ++column) {
        task.updates(kept_, column * all + first, column * all + last);
    }
}

}  // namespace weft
