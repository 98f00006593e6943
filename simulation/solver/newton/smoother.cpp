#include "simulation/solver/newton/smoother.h"

#include "kernels/vbd/solve.h"

namespace weft {

NewtonSmoother::NewtonSmoother(Model& model, DescentSubstep& substep, const VertexGraph& graph,
                               Kinds kinds)
    : items(make_vertex_layout(graph, model.strips)),
      derivatives(model, items),
      seams{"seams", kinds.seams, {}},
      strips{"strips", kinds.strips, {}} {
    ContactResponse* contact = substep.contact();
    for (const Phase phase : {kSeamPhase, kInnerPhase}) {
        TaskBody& body = phase == kSeamPhase ? seams : strips;
        body.launches = derivatives.gather(phase, *model.positions);
        if (contact != nullptr) {
            body.launches.push_back(
                contact->gather(phase, *model.positions, items, derivatives.sums()));
        }
        body.launches.push_back(launch(kernels::solve_vertices, items.segments(phase),
                                       *model.positions, substep.targets(), items.vertices(),
                                       derivatives.sums(), items.count(),
                                       static_cast<float>(1.0 / (model.h * model.h))));
        body.taking_turns = static_cast<int>(body.launches.size());
    }
    substep.momentum().add_obstacles(strips.launches, *model.positions);
    if (contact == nullptr) return;
    contact->add_truncation(strips.launches, *model.positions);
    contact->add_snapshot(strips.launches, *model.positions);
}

}  // namespace weft
