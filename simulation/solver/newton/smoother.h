#pragma once

#include "runtime/step.h"
#include "simulation/families/vertex_items.h"
#include "simulation/solver/derivatives.h"
#include "simulation/solver/descent.h"
#include "simulation/topology/vertex_graph.h"

namespace weft {

/// Sweeps of vertex block descent (sweeps.h) behind a step of Newton's method.
struct NewtonSmoother {
    struct Kinds {
        int seams, strips;
    };
    /// graph: of all elements of the model. kinds: of the tasks
    NewtonSmoother(Model& model, DescentSubstep& substep, const VertexGraph& graph, Kinds kinds);

    VertexItems items;
    VertexDerivatives derivatives;
    TaskBody seams, strips;
};

}  // namespace weft
