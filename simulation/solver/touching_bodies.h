#pragma once

#include <vector>

#include "simulation/contact/response.h"
#include "simulation/solver/free_bodies.h"

namespace weft {

/// Free bodies in scenes with contact: they move as wholes as far as their contacts let them
/// (kernels/contact/bodies.h). Sums as FreeBodies', and a task of one device that makes steps of
/// them.
class TouchingBodies {
public:
    /// kind: of the task. All others must outlive this.
    TouchingBodies(const Model& model, FreeBodies& bodies, ContactResponse& contact, int kind);

    // As FreeBodies'.
    std::vector<Launch> sum(Buffer<float4>& positions, Buffer<float4>& targets);
    void add_sum_accesses(Step::Adding& task, const Region& region, Buffer<float4>& positions);
    Launch shift(Model& model, Buffer<float4>& deviations);
    void add_shift_accesses(Step::Adding& task);

    /// Between all sums and shifts: the steps.
    const TaskBody& steps() const { return steps_; }
    void add_steps(Step& step, int iteration);

private:
    void number_bodies(const Model& model);
    std::vector<Launch> solve();
    int body_count() const { return groups_.body_count(); }

    const Model& model_;
    FreeBodies& bodies_;
    ContactResponse& contact_;
    ContactRows rows_;
    BodyGroups& groups_;
    int lag_count_;
    // See the kernels.
    Buffer<float4> partials_;      ///< [parts * columns]
    Buffer<float4> lags_;          ///< [parts * lag_count]
    Buffer<int> body_of_;          ///< [vertices]
    Buffer<int> first_run_;        ///< [bodies]
    Buffer<float> counts_;         ///< [bodies]
    Buffer<float> masses_;         ///< [bodies]
    Buffer<float4> rests_;         ///< [3 * bodies]
    Buffer<float4> group_shifts_;  ///< [bodies]
    Buffer<float4> shifts_;        ///< [bodies + 1]
    Buffer<int> begin_;            ///< [strips + 1] all bodies are items of strip 0
    TaskBody steps_;
};

}  // namespace weft
