#include "simulation/solver/body_moments.h"

#include "kernels/bodies/moments.h"

namespace weft {

BodyMoments::BodyMoments(FreeBodies& bodies, Buffer<int>& first_run, Buffer<float>& counts)
    : bodies_(bodies),
      first_run_(first_run),
      counts_(counts),
      sums_(bodies),
      moments_("touching.moments",
               WEFT_MOMENT_PARTS * static_cast<std::size_t>(bodies.body_count() + 1)) {}

Launch BodyMoments::weigh(const Segments& all) {
    return launch(kernels::weigh_bodies, all, sums_.sums(), first_run_, counts_, moments_,
                  bodies_.most_runs(), bodies_.body_count());
}

void BodyMoments::add_weigh_accesses(Step::Adding& task) {
    sums_.add_reads(task);
    task.updates(moments_, 0, static_cast<int>(moments_.count()));
}

void BodyMoments::add_reads(Step::Adding& task) {
    task.reads(moments_, 0, static_cast<int>(moments_.count()));
}

}  // namespace weft
