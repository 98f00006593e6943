#include "simulation/contact/projection.h"

#include "kernels/xpbd/contacts.h"

namespace weft {

ContactProjection::ContactProjection(Model& model, ContactResponse& contact)
    : model_(model),
      rows_(contact.rows()),
      snapshots_(contact.snapshots()),
      least_(contact.least()),
      rubbing_(contact.rubbing()),
      multipliers_(rows_.table.add_column<float>("multipliers")),
      rubs_(rubbing_.friction > 0.0 ? &rows_.table.add_column<float4>("rubs") : nullptr) {
    contact.show_start(share(0), share(1));
}

Launch ContactProjection::share(int ahead) {
    return only_where(rows_.touching,
                      launch(kernels::share_masses, model_.vertices(), *model_.positions,
                             rows_.table.rows(), rows_.table.counts(), rows_.measures, least_,
                             snapshots_, model_.vertex_count(), kIteration, ahead));
}

void ContactProjection::add_snapshot(std::vector<Launch>& launches) {
    launches.push_back(share(0));
}

void ContactProjection::add_snapshot_accesses(Step::Adding& task, int iteration, int first_strip,
                                              int end_strip) {
    const int first = model_.vertices().item(first_strip);
    const int last = model_.vertices().item(end_strip);
    const int half = iteration % 2 * model_.vertex_count();
    task.reads(rows_.touching, first_strip, end_strip)
        .reads(rows_.table.counts(), first, last)
        .reads(rows_.measures, rows_.table.entries(), first_strip, end_strip)
        .reads(least_, first, last)
        .updates(snapshots_, half + first, half + last);
}

void ContactProjection::add_project(std::vector<Launch>& launches) {
    launches.push_back(only_where(rows_.touching, push()));
    if (rubs_ != nullptr) launches.push_back(only_where(rows_.touching, rub()));
}

Launch ContactProjection::push() {
    return launch(kernels::project_contacts, model_.vertices(), *model_.positions, snapshots_,
                  rows_.table.rows(), rows_.table.counts(), rows_.corner0, rows_.corner1,
                  rows_.corner2, rows_.corner3, rows_.normals, rows_.weights, rows_.measures,
                  multipliers_, model_.vertex_count(),
                  static_cast<float>(1.0 / (model_.h * model_.h)), kIteration);
}

Launch ContactProjection::rub() {
    return launch(kernels::rub_contacts, model_.vertices(), *model_.positions, snapshots_,
                  rows_.table.rows(), rows_.table.counts(), rows_.corner0, rows_.corner1,
                  rows_.corner2, rows_.corner3, rows_.normals, rows_.weights, rows_.measures,
                  rows_.slips, multipliers_, *rubs_, model_.vertex_count(), kIteration,
                  static_cast<float>(rubbing_.friction), static_cast<float>(rubbing_.creep));
}

void ContactProjection::add_project_accesses(Step::Adding& task, int iteration, int first_strip,
                                             int end_strip) {
    const int all = model_.vertex_count();
    const int half = iteration % 2 * all;
    const int next = all - half;
    const int first = model_.vertices().item(first_strip);
    const int last = model_.vertices().item(end_strip);
    task.updates(*model_.positions, first, last)
        .reads(snapshots_, half, half + all)
        .updates(snapshots_, next + first, next + last)
        .updates(multipliers_, rows_.table.entries());
    if (rubs_ != nullptr) task.updates(*rubs_, rows_.table.entries());
    rows_.add_reads(task, first_strip, end_strip, first, last);
}

}  // namespace weft
