#include "simulation/solver/marked_bodies.h"

namespace weft {

void mark_bodies(const Model& model, std::string_view kind, Buffer<float>& flags) {
    for (const BodyRange& body : model.bodies) {
        if (body.kind != kind) continue;
        for (int own = 0; own < body.vertex_count; ++own) {
            flags[static_cast<std::size_t>(model.vertex(body.vertex(own)))] = 1.0f;
        }
    }
}

}  // namespace weft
