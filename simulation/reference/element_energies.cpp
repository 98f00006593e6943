#include "simulation/reference/element_energies.h"

namespace weft {

std::vector<std::unique_ptr<ElementEnergies>> make_element_energies(const Model& model) {
    std::vector<std::unique_ptr<ElementEnergies>> energies;
    if (model.springs) energies.push_back(make_spring_energies(*model.springs));
    if (model.membranes) energies.push_back(make_membrane_energies(*model.membranes));
    if (model.tetrahedra) energies.push_back(make_tetrahedron_energies(*model.tetrahedra));
    if (model.hinges) energies.push_back(make_hinge_energies(*model.hinges));
    return energies;
}

}  // namespace weft
