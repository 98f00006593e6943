#include "simulation/solver/cloth_reactions.h"

#include <algorithm>
#include <optional>

#include "kernels/descent/cloth_reactions.h"
#include "simulation/solver/marked_bodies.h"

namespace weft {

namespace {

bool is_cloth(const BodyRange& body) { return body.kind == "cloth"; }

}  // namespace

std::unique_ptr<ClothReactions> ClothReactions::of(Model& model, ContactResponse* contact) {
    if (!model.obstacles || std::ranges::none_of(model.bodies, is_cloth)) return nullptr;
    return std::make_unique<ClothReactions>(model, contact);
}

ClothReactions::ClothReactions(Model& model, ContactResponse* contact)
    : model_(model), contact_(contact), cloth_("reactions.cloth", model.positions->count()) {
    mark_bodies(model, "cloth", cloth_);
}

Launch ClothReactions::lead(VertexItems& items, Phase phase, Buffer<float4>& positions,
                            const Pushes& pushes, Buffer<float>& sums) {
    NarrowObstacles* narrow = model_.obstacles->narrow();
    const auto rows = contact_ ? std::optional(contact_->rows()) : std::nullopt;
    Buffer<int>& none = items.vertices();
    return launch(kernels::lead_cloth, items.segments(phase), positions, *model_.previous,
                  pushes.starts, pushes.targets, cloth_, items.vertices(), sums,
                  model_.obstacles->placements(), narrow ? narrow->planes() : *model_.previous,
                  rows ? rows->table.rows() : none, rows ? rows->table.counts() : none,
                  rows ? rows->corner0 : none, rows ? rows->corner1 : none,
                  rows ? rows->corner2 : none, rows ? rows->corner3 : none, items.count(),
                  static_cast<float>(1.0 / (model_.h * model_.h)), rows ? 1 : 0,
                  narrow ? narrow->count() : 0, narrow ? narrow->vertex_count() : 0,
                  model_.obstacles->count(), kInstance);
}

void ClothReactions::add_accesses(Step::Adding& task, int first, int last) {
    task.reads(*model_.previous, first, last);
    NarrowObstacles* narrow = model_.obstacles->narrow();
    if (!narrow) return;
    for (int k = 0; k < narrow->count(); ++k) {
        const int column = k * narrow->vertex_count();
        task.reads(narrow->planes(), column + first, column + last);
    }
}

}  // namespace weft
