#include "simulation/contact/insides.h"

#include "kernels/obstacles/inside.h"

namespace weft {

Insides::Insides(Model& model)
    : model_(model),
      depths_("contact.depths", model.positions->count()),
      obstacles_("contact.insides", model.positions->count()) {}

void Insides::add_launch(std::vector<Launch>& launches, Buffer<int>& cut) {
    launches.push_back(launch(kernels::find_inside, model_.vertices(), *model_.positions,
                              *model_.previous, model_.obstacles->placements(), cut, depths_,
                              obstacles_, model_.obstacles->count(), kInstance));
}

void Insides::add_accesses(Step::Adding& task, int first, int last) {
    task.updates(depths_, first, last).updates(obstacles_, first, last);
}

}  // namespace weft
