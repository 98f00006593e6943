#include "simulation/checks/borne_bodies.h"

#include <algorithm>

#include "simulation/model/model.h"
#include "simulation/topology/components.h"

namespace weft {

namespace {

/// [vertices]
std::vector<char> hang_on_pins(const Model& model) {
    std::vector<char> hang(model.positions->count());
    const std::vector<int> begins = component_begins(model.vertex_count(), model.stencils());
    for (std::size_t c = 0; c + 1 < begins.size(); ++c) {
        const auto positions =
            model.positions->span().subspan(static_cast<std::size_t>(begins[c]),
                                            static_cast<std::size_t>(begins[c + 1] - begins[c]));
        const bool is_held = std::ranges::any_of(positions, [](float4 x) { return x.w <= 0.0f; });
        std::fill(hang.begin() + begins[c], hang.begin() + begins[c + 1], is_held ? 1 : 0);
    }
    return hang;
}

}  // namespace

std::vector<char> borne_bodies(const Model& model, const SubstepEnds& ends) {
    const std::vector<char> hang = hang_on_pins(model);
    std::vector<char> touch(model.positions->count());  // in scene order
    for (const FrozenContact& contact : ends.contacts) {
        for (const int corner : contact.corners) touch[static_cast<std::size_t>(corner)] = 1;
    }
    std::vector<char> borne;
    for (const BodyRange& body : model.bodies) {
        bool is_borne = false;
        bool is_pushed = false;
        for (int own = 0; own < body.vertex_count; ++own) {
            const SceneVertex vertex = body.vertex(own);
            const auto v = static_cast<std::size_t>(model.vertex(vertex));
            is_borne = is_borne || hang[v] != 0 || touch[index(vertex)] != 0;
            const bool is_free = (*model.positions)[v].w > 0.0f;
            is_pushed =
                is_pushed || (is_free && !ends.held.empty() && ends.held[index(vertex)] != 0);
        }
        borne.push_back(is_borne && !is_pushed ? 1 : 0);
    }
    return borne;
}

}  // namespace weft
