#include "simulation/contact/energy.h"

#include "kernels/contact/rising.h"
#include "kernels/contact/terms.h"

namespace weft {

ContactEnergy::ContactEnergy(Model& model, const ContactRows& rows, Sticking* sticking, int kind)
    : model_(model),
      rows_(rows),
      sticking_(sticking),
      energies_("contact.energies", 2 * model.positions->count()),
      body_{"contact energy",
            kind,
            {launch(kernels::measure_contacts, model.vertices(), *model.positions, *model.previous,
                    rows.table.rows(), rows.table.counts(), rows.corner0, rows.corner1,
                    rows.corner2, rows.corner3, rows.normals, rows.weights, rows.measures,
                    energies_, model.vertex_count(), kInstance)}} {
    if (sticking_ != nullptr) sticking_->add_keep(body_.launches);
}

void ContactEnergy::let_rise(Buffer<float4>& targets) {
    targets_ = &targets;
    body_.launches.push_back(launch(kernels::let_rise, model_.vertices(), *model_.positions,
                                    *model_.velocities, rows_.table.rows(), rows_.table.counts(),
                                    rows_.corner0, rows_.corner1, rows_.corner2, rows_.corner3,
                                    rows_.normals, rows_.weights, rows_.measures, targets,
                                    *model_.gravity, static_cast<float>(model_.h), kInstance));
}

void ContactEnergy::add(Step& step, const std::vector<Region>& regions, int iteration) {
    const int all = model_.vertex_count();
    for (const Region& region : regions) {
        const int first = model_.vertices().item(region.begin);
        const int last = model_.vertices().item(region.end);
        auto task = step.add(body_, iteration, region.strips(), region.id);
        task.reads(*model_.positions, 0, all)
            .reads(*model_.previous, 0, all)
            .updates(energies_, first, last)
            .updates(energies_, all + first, all + last);
        rows_.add_reads(task, region.begin, region.end, first, last);
        if (sticking_ != nullptr) sticking_->add_keep_accesses(task, first, last);
        if (targets_ == nullptr) continue;
        task.reads(*model_.velocities, first, last).updates(*targets_, first, last);
    }
}

double ContactEnergy::sum_of(int column) const {
    const auto count = static_cast<std::size_t>(model_.vertex_count());
    double sum = 0.0;
    for (std::size_t v = 0; v < count; ++v) {
        sum += static_cast<double>(energies_[static_cast<std::size_t>(column) * count + v]);
    }
    return sum;
}

StoredInContacts ContactEnergy::stored() const { return {sum_of(0), sum_of(1)}; }

Launch ContactEnergy::terms(Buffer<float4>& positions, Buffer<int>& slots, Buffer<float>& terms) {
    return launch(kernels::contact_terms, model_.vertices(), positions, rows_.table.rows(),
                  rows_.table.counts(), rows_.corner0, rows_.corner1, rows_.corner2, rows_.corner3,
                  rows_.normals, rows_.weights, rows_.measures, slots, terms);
}

void ContactEnergy::add_terms_accesses(Step::Adding& task, int first_strip, int end_strip) const {
    rows_.add_reads(task, first_strip, end_strip, model_.vertices().item(first_strip),
                    model_.vertices().item(end_strip));
}

}  // namespace weft
