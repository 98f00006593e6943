#include "simulation/solver/own_iterates.h"

#include <algorithm>
#include <bit>

#include "kernels/descent/substep.h"
#include "scheduler/assert.h"

namespace weft {

OwnIterates::OwnIterates(const Model& model, std::unique_ptr<Solver> solver, int iterates)
    : solver_(std::move(solver)),
      exchange_kind_(static_cast<int>(solver_->kinds().size())),
      iterates_(model, *solver_, iterates) {
    WEFT_ASSERT(iterates >= 1 && iterates < 32);
    for (std::size_t b = 0; b < iterates_.buffer_count(); ++b) {
        auto& bodies = exchange_.emplace_back();
        for (int from = 0; from < iterates; ++from) {
            for (int to = 0; to < iterates; ++to) {
                TaskBody& body = bodies.emplace_back(TaskBody{"exchange", exchange_kind_, {}});
                if (from == to) continue;
                body.launches.push_back(launch(kernels::copy_positions, iterates_.pieces(),
                                               iterates_.in(b, from), iterates_.in(b, to)));
            }
        }
    }
}

std::vector<const TaskBody*> OwnIterates::bodies() const {
    std::vector<const TaskBody*> list = solver_->bodies();
    for (const TaskBody* body : iterates_.other_bodies()) list.push_back(body);
    for (const auto& bodies : exchange_) {
        for (const TaskBody& body : bodies) {
            if (!body.launches.empty()) list.push_back(&body);
        }
    }
    return list;
}

std::vector<std::string> OwnIterates::kinds() const {
    std::vector<std::string> names = solver_->kinds();
    names.emplace_back("exchange");
    return names;
}

/// Goes through a step's tasks in their order and puts each into its part's iterate, behind copies
/// of what is not current there: as caches do it, by pieces.
class OwnIterates::Placing {
public:
    Placing(OwnIterates& solver, const Partition& partition)
        : solver_(solver),
          partition_(partition),
          current_(solver.iterates_.buffer_count(),
                   std::vector<unsigned>(
                       static_cast<std::size_t>(solver.iterates_.pieces().strip_count), 1U)) {}

    void add(const Task& task) {
        const int iterate = partition_.parts[index(task.region)].iterate;
        WEFT_ASSERT(iterate >= 0 && iterate < solver_.iterates_.count());
        Task own = task;
        own.body = &solver_.iterates_.body_for(*task.body, iterate);
        for (Access& access : own.accesses) {
            const std::size_t buffer = solver_.iterates_.index_of(access.buffer);
            if (buffer == solver_.iterates_.buffer_count()) continue;
            WEFT_ASSERT(access.segments == nullptr);
            bring(buffer, access, iterate, own);
            access.buffer = &solver_.iterates_.in(buffer, iterate);
        }
        step_.add(own);
    }

    /// What is not current in iterate 0 at the end is brought there by the part that has it.
    Step finish() {
        for (std::size_t r = 0; r < partition_.parts.size(); ++r) {
            const Part& part = partition_.parts[r];
            Task task;
            task.iteration = last_iteration_;
            task.region = RegionId{static_cast<int>(r)};
            for (std::size_t c = 0; c < current_.size(); ++c) {
                for (int half = 0; half < solver_.iterates_.halves(c); ++half) {
                    const int first = half * solver_.iterates_.pieces_per_half();
                    bring_pieces(c, first + Iterates::kPiecesPerStrip * part.begin,
                                 first + Iterates::kPiecesPerStrip * part.end, 0, task);
                }
            }
        }
        step_.seal();
        return std::move(step_);
    }

private:
    void bring(std::size_t copies, const Access& access, int iterate, const Task& reader) {
        const auto [first, last] = solver_.iterates_.pieces_with(access.begin, access.end);
        bring_pieces(copies, first, last, iterate, reader);
        if (!access.writes) return;
        for (int piece = first; piece < last; ++piece) {
            current_[copies][static_cast<std::size_t>(piece)] = 1U << iterate;
        }
        last_iteration_ = std::max(last_iteration_, reader.iteration);
    }

    /// One task for pieces that lie side by side and come from one iterate.
    void bring_pieces(std::size_t copies, int first, int last, int iterate, const Task& reader) {
        int begin = first;
        while (begin < last) {
            const int from = source(copies, begin, iterate);
            int end = begin + 1;
            while (end < last && source(copies, end, iterate) == from) ++end;
            if (from != iterate) copy(copies, from, iterate, begin, end, reader);
            begin = end;
        }
    }

    /// Where a piece is current: in that iterate, or else the first of those that have it.
    int source(std::size_t copies, int piece, int iterate) const {
        const unsigned in = current_[copies][static_cast<std::size_t>(piece)];
        WEFT_ASSERT(in != 0);
        return (in >> iterate & 1U) != 0 ? iterate : std::countr_zero(in);
    }

    void copy(std::size_t copies, int from, int to, int begin, int end, const Task& reader) {
        const Iterates& all = solver_.iterates_;
        const auto body = static_cast<std::size_t>(from * all.count() + to);
        const int first = all.pieces().item(begin);
        const int last = all.pieces().item(end);
        for (int piece = begin; piece < end; ++piece) {
            current_[copies][static_cast<std::size_t>(piece)] |= 1U << to;
        }
        if (first == last) return;
        step_.add(solver_.exchange_[copies][body], reader.iteration, {begin, end}, reader.region)
            .reads(all.in(copies, from), first, last)
            .updates(all.in(copies, to), first, last);
    }

    OwnIterates& solver_;
    const Partition& partition_;
    std::vector<std::vector<unsigned>> current_;  ///< [copies][piece] a bit per iterate
    int last_iteration_ = 0;
    Step step_;
};

Step OwnIterates::make_step(const Partition& partition) {
    const Step shared = solver_->make_step(partition);
    Placing placing(*this, partition);
    for (const Task& task : shared.tasks()) placing.add(task);
    return placing.finish();
}

}  // namespace weft
