#include "simulation/solver/body_strains.h"

#include <algorithm>

#include "kernels/contact/strains.h"
#include "simulation/families/tetrahedra/tetrahedra.h"

namespace weft {

namespace {

constexpr int kParts = WEFT_VIRIAL_PARTS;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

std::unique_ptr<BodyStrains> BodyStrains::of(Model& model, FreeBodies& bodies,
                                             const Buffer<int>& body_of) {
    if (model.find<Tetrahedra>() == nullptr) return nullptr;
    std::unique_ptr<BodyStrains> strains(new BodyStrains(model, bodies));
    return strains->weigh(model, body_of) ? std::move(strains) : nullptr;
}

BodyStrains::BodyStrains(Model& model, FreeBodies& bodies)
    : bodies_(bodies),
      items_(model.strips),
      derivatives_(model, items_),
      sum_count_(bodies.run_count() + bodies.most_runs()),
      partials_("touching.virials.partials", at(kParts * bodies.column_count())),
      virials_("touching.virials", at(kParts * sum_count_)),
      stiffness_("touching.stiffness", at(2 * bodies.body_count())) {}

/// Whether there are any. Cloth that is tied to a solid is not counted: it gives way by itself.
bool BodyStrains::weigh(const Model& model, const Buffer<int>& body_of) {
    const auto& solids = *model.find<Tetrahedra>();
    bool has_any = false;
    for (int t = 0; t < solids.elements().count(); ++t) {
        const int body = body_of[at(solids.elements().vertices_of(t)[0])];
        if (body == bodies_.body_count()) continue;
        has_any = true;
        stiffness_[at(body)] += static_cast<float>(solids.mu(t));
        stiffness_[at(bodies_.body_count() + body)] +=
            static_cast<float>(solids.lambda(t) - solids.mu(t));
    }
    return has_any;
}

std::vector<Launch> BodyStrains::sum(Buffer<float4>& positions, Buffer<int>& origins) {
    const BodyColumns columns = bodies_.columns();
    std::vector<Launch> launches = derivatives_.gather_gradients(kInnerPhase, positions);
    launches.push_back(launch(kernels::add_virials, columns.by_strip, positions,
                              derivatives_.sums(), columns.members, columns.shares, columns.rows,
                              origins, partials_, columns.count, items_.count()));
    launches.push_back(bodies_.add_columns(partials_, virials_, {kParts, sum_count_, 1}));
    return launches;
}

void BodyStrains::add_sum_accesses(Step::Adding& task, const Region& region) {
    const auto [first, last] = bodies_.runs_in(region.begin, region.end);
    for (int part = 0; part < kParts; ++part) {
        task.updates(virials_, part * sum_count_ + first, part * sum_count_ + last);
    }
}

void BodyStrains::add_reads(Step::Adding& task) {
    for (int part = 0; part < kParts; ++part) {
        task.reads(virials_, part * sum_count_, part * sum_count_ + bodies_.run_count());
    }
}

}  // namespace weft
