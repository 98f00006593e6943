#include "simulation/solver/lone_bodies.h"

#include "kernels/bodies/free_bodies.h"

namespace weft {

LoneBodies::LoneBodies(FreeBodies& bodies, float held)
    : bodies_(bodies),
      held_(held),
      sums_(bodies),
      motions_("free.motions", 3 * static_cast<std::size_t>(bodies.run_count() + 1)) {}

std::vector<Launch> LoneBodies::move(Model& model, Buffer<float4>& deviations) {
    const BodyRuns runs = bodies_.runs();
    return {launch(kernels::solve_runs, runs.by_strip, sums_.sums(), runs.first, runs.counts,
                   motions_, bodies_.most_runs(), bodies_.run_count(), held_),
            launch(kernels::move_runs, model.vertices(), *model.positions, deviations,
                   *model.velocities, motions_, bodies_.run_of_vertices(),
                   static_cast<float>(1.0 / model.h), bodies_.run_count())};
}

}  // namespace weft
