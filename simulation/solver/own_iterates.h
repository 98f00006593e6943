#pragma once

#include <memory>
#include <vector>

#include "simulation/solver/solver.h"

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
    int iterate_count() const override { return iterates_; }
    std::vector<const Buffer<float4>*> other_iterates() const override;
    Step make_step(const Partition& partition) override;

private:
    /// One buffer of the iterate, in all iterates.
    struct Copies {
        Buffer<float4>* own = nullptr;                       ///< iterate 0
        std::vector<std::unique_ptr<Buffer<float4>>> other;  ///< [iterate - 1]
        std::vector<TaskBody> exchange;                      ///< [from * iterates + to]

        Buffer<float4>& in(int iterate) {
            return iterate == 0 ? *own : *other[static_cast<std::size_t>(iterate - 1)];
        }
    };
    /// A body of the solver, as it is in all iterates but 0.
    struct Elsewhere {
        const TaskBody* body = nullptr;
        std::vector<std::unique_ptr<TaskBody>> in;  ///< [iterate - 1]
    };
    class Placing;

    void cut_pieces(const Model& model);
    void add_copies(Buffer<float4>& own);
    void add_bodies();
    TaskBody body_in(const TaskBody& body, int iterate);
    Copies* copies_of(const BufferStorage* buffer);
    const TaskBody& body_for(const TaskBody& body, int iterate) const;

    std::unique_ptr<Solver> solver_;
    int iterates_;
    int exchange_kind_;
    /// What is copied at once: of each strip what its first seam touches, the middle, and what its
    /// last seam touches. So devices that work on the two seams of a strip do not disturb each
    /// other.
    std::unique_ptr<Buffer<int>> piece_begin_;  ///< [pieces + 1]
    Segments pieces_;
    std::vector<std::unique_ptr<Copies>> copies_;  ///< as the solver's iterate()
    std::vector<Elsewhere> elsewhere_;             ///< bodies that touch the iterate
};

}  // namespace weft
