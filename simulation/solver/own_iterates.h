#pragma once

#include <memory>
#include <vector>

#include "simulation/solver/iterates.h"

namespace weft {

/// A solver whose parts may work on iterates of their own (Part::iterate): for devices that shall
/// not share one. The results are the other solver's, to the bit: whatever a task reads that was
/// written in another iterate is copied before it, by tasks of the kind "exchange".
///
/// Iterate 0 are the solver's own buffers. At a substep's begin and end they are current.
class OwnIterates final : public Solver {
public:
    /// iterates: how many there are in all, at least 1. The model must outlive this.
    OwnIterates(const Model& model, std::unique_ptr<Solver> solver, int iterates);

    std::vector<const TaskBody*> bodies() const override;
    std::vector<std::string> kinds() const override;
    std::vector<BufferStorage*> state() override { return solver_->state(); }
    std::vector<RowTable*> tables() override { return solver_->tables(); }
    ContactResponse* contact() override { return solver_->contact(); }
    std::vector<Buffer<float4>*> iterate() override { return solver_->iterate(); }
    int iterate_count() const override { return iterates_.count(); }
    std::vector<const Buffer<float4>*> other_iterates() const override {
        return iterates_.others();
    }
    Step make_step(const Partition& partition) override;

private:
    class Placing;

    std::unique_ptr<Solver> solver_;
    int exchange_kind_;
    Iterates iterates_;
    std::vector<std::vector<TaskBody>> exchange_;  ///< [buffer][from * iterates + to]
};

}  // namespace weft
