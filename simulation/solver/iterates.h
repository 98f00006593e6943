#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "simulation/solver/solver.h"

namespace weft {

/// What parts of a solver exchange (Solver::iterate()), in several places: iterates that parts work
/// on, of which number 0 are the solver's own buffers, and slots, in which values wait to be read.
/// The solver's bodies are there for each iterate.
class Iterates {
public:
    /// The model and the solver must outlive this.
    Iterates(const Model& model, Solver& solver, int iterates, int slots = 0);

    int count() const { return iterates_; }  ///< without slots
    int place_count() const { return iterates_ + slots_; }
    std::size_t buffer_count() const { return buffers_.size(); }
    Buffer<float4>& in(std::size_t buffer, int place) const;
    /// The number of a buffer of the solver; buffer_count(): it is none of these.
    std::size_t index_of(const BufferStorage* buffer) const;

    /// What is copied at once: of each strip what its first seam touches, the middle, and what its
    /// last seam touches. So devices that work on the two seams of a strip do not disturb each
    /// other. Those of all strips, and once more for the second half of buffers that have one.
    const Segments& pieces() const { return pieces_; }
    static constexpr int kPiecesPerStrip = 3;
    int pieces_per_half() const { return pieces_.strip_count / 2; }
    int halves(std::size_t buffer) const;
    /// The pieces with some vertex in [begin, end), and perhaps empty ones beside them.
    std::pair<int, int> pieces_with(int begin, int end) const;

    /// A body of the solver, as it is in an iterate.
    const TaskBody& body_for(const TaskBody& body, int iterate) const;
    /// All of them but the solver's own.
    std::vector<const TaskBody*> other_bodies() const;
    std::vector<const Buffer<float4>*> others() const;

private:
    struct Copies {
        Buffer<float4>* own = nullptr;
        std::vector<std::unique_ptr<Buffer<float4>>> other;  ///< [place - 1]
    };
    /// A body of the solver, as it is in all iterates but 0.
    struct Elsewhere {
        const TaskBody* body = nullptr;
        std::vector<std::unique_ptr<TaskBody>> in;  ///< [iterate - 1]
    };
    void cut_pieces(const Model& model);
    void add_copies(Buffer<float4>& own);
    void add_bodies(const Solver& solver);
    TaskBody body_in(const TaskBody& body, int iterate) const;

    int iterates_;
    int slots_;
    std::unique_ptr<Buffer<int>> piece_begin_;  ///< [pieces + 1]
    Segments pieces_;
    std::vector<Copies> buffers_;       ///< as the solver's iterate()
    std::vector<Elsewhere> elsewhere_;  ///< bodies that touch the iterate
};

}  // namespace weft
