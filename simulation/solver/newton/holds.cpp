#include "simulation/solver/newton/holds.h"

#include "kernels/newton/holds.h"
#include "simulation/solver/marked_bodies.h"

namespace weft {

std::unique_ptr<NewtonHolds> NewtonHolds::of(Model& model, DescentSubstep& substep,
                                             Buffer<float>& control) {
    if (!model.obstacles && substep.contact() == nullptr) return nullptr;
    return std::make_unique<NewtonHolds>(model, substep, control);
}

NewtonHolds::NewtonHolds(Model& model, DescentSubstep& substep, Buffer<float>& control)
    : model_(model),
      substep_(substep),
      control_(control),
      solid_("newton.solid", model.positions->count()),
      holds_("newton.holds", model.positions->count()) {
    mark_bodies(model, "solid", solid_);
}

Launch NewtonHolds::find(Buffer<float>& sums) {
    ContactResponse* contact = substep_.contact();
    Obstacles* obstacles = model_.obstacles.get();
    Buffer<float4>& positions = *model_.positions;
    return launch(kernels::find_holds, model_.vertices(), positions, *model_.previous,
                  obstacles ? *substep_.momentum().starts() : positions, substep_.targets(), sums,
                  solid_, contact ? contact->cut() : none_, control_,
                  obstacles ? obstacles->placements() : positions, holds_, model_.vertex_count(),
                  contact ? 1 : 0, obstacles ? obstacles->count() : 0,
                  static_cast<float>(1.0 / (model_.h * model_.h)), kInstance);
}

void NewtonHolds::add_find_accesses(Step::Adding& task, int first, int last) {
    task.reads(*model_.previous, first, last)
        .reads(control_, 0, static_cast<int>(control_.count()))
        .updates(holds_, first, last);
    if (model_.obstacles) task.reads(*substep_.momentum().starts(), first, last);
    if (substep_.contact() != nullptr) task.reads(substep_.contact()->cut(), first, last);
}

}  // namespace weft
