#include "simulation/solver/own_iterates.h"

#include <algorithm>
#include <bit>

#include "kernels/descent/substep.h"
#include "scheduler/assert.h"

namespace weft {

namespace {

constexpr int kPiecesPerStrip = 3;

}  // namespace

OwnIterates::OwnIterates(const Model& model, std::unique_ptr<Solver> solver, int iterates)
    : solver_(std::move(solver)),
      iterates_(iterates),
      exchange_kind_(static_cast<int>(solver_->kinds().size())) {
    WEFT_ASSERT(iterates >= 1 && iterates < 32);
    cut_pieces(model);
    for (Buffer<float4>* buffer : solver_->iterate()) add_copies(*buffer);
    add_bodies();
}

void OwnIterates::cut_pieces(const Model& model) {
    const Strips& strips = model.strips;
    const int count = strips.count();
    piece_begin_ = std::make_unique<Buffer<int>>(
        "pieces", static_cast<std::size_t>(kPiecesPerStrip * count + 1));
    int* next = piece_begin_->data();
    for (int s = 0; s < count; ++s) {
        const int begin = model.vertices().item(s);
        const int end = model.vertices().item(s + 1);
        const int first_seam_end = s > 0 ? strips.seam_end[static_cast<std::size_t>(s - 1)] : begin;
        const int last_seam_begin =
            s + 1 < count ? strips.seam_begin[static_cast<std::size_t>(s)] : end;
        *next++ = begin;
        *next++ = std::clamp(first_seam_end, begin, end);
        *next++ = std::clamp(last_seam_begin, std::clamp(first_seam_end, begin, end), end);
    }
    *next = model.vertex_count();
    WEFT_ASSERT(std::is_sorted(piece_begin_->data(), next + 1));
    pieces_ = {piece_begin_.get(), 0, 1, kPiecesPerStrip * count};
}

void OwnIterates::add_copies(Buffer<float4>& own) {
    Copies& copies = *copies_.emplace_back(std::make_unique<Copies>());
    copies.own = &own;
    for (int k = 1; k < iterates_; ++k) {
        copies.other.push_back(
            std::make_unique<Buffer<float4>>(own.name() + "." + std::to_string(k), own.count()));
    }
    for (int from = 0; from < iterates_; ++from) {
        for (int to = 0; to < iterates_; ++to) {
            TaskBody& body = copies.exchange.emplace_back(TaskBody{"exchange", exchange_kind_, {}});
            if (from == to) continue;
            body.launches.push_back(
                launch(kernels::copy_positions, pieces_, copies.in(from), copies.in(to)));
        }
    }
}

OwnIterates::Copies* OwnIterates::copies_of(const BufferStorage* buffer) {
    const auto found =
        std::ranges::find_if(copies_, [&](const auto& copies) { return copies->own == buffer; });
    return found == copies_.end() ? nullptr : found->get();
}

void OwnIterates::add_bodies() {
    for (const TaskBody* body : solver_->bodies()) {
        const bool touches = std::ranges::any_of(body->launches, [&](const Launch& launch) {
            return std::ranges::any_of(launch.arguments, [&](const Argument& a) {
                return copies_of(a.buffer) != nullptr;
            });
        });
        if (!touches) continue;
        Elsewhere& elsewhere = elsewhere_.emplace_back(Elsewhere{body, {}});
        for (int k = 1; k < iterates_; ++k) {
            elsewhere.in.push_back(std::make_unique<TaskBody>(body_in(*body, k)));
        }
    }
}

TaskBody OwnIterates::body_in(const TaskBody& body, int iterate) {
    TaskBody other = body;
    for (Launch& launch : other.launches) {
        for (Argument& argument : launch.arguments) {
            if (Copies* copies = copies_of(argument.buffer)) argument.buffer = &copies->in(iterate);
        }
    }
    return other;
}

const TaskBody& OwnIterates::body_for(const TaskBody& body, int iterate) const {
    const auto found = std::ranges::find(elsewhere_, &body, &Elsewhere::body);
    if (iterate == 0 || found == elsewhere_.end()) return body;
    return *found->in[static_cast<std::size_t>(iterate - 1)];
}

std::vector<const TaskBody*> OwnIterates::bodies() const {
    std::vector<const TaskBody*> list = solver_->bodies();
    for (const Elsewhere& elsewhere : elsewhere_) {
        for (const auto& body : elsewhere.in) list.push_back(body.get());
    }
    for (const auto& copies : copies_) {
        for (const TaskBody& body : copies->exchange) {
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

std::vector<const Buffer<float4>*> OwnIterates::other_iterates() const {
    std::vector<const Buffer<float4>*> list;
    for (const auto& copies : copies_) {
        for (const auto& other : copies->other) list.push_back(other.get());
    }
    return list;
}

/// Goes through a step's tasks in their order and puts each into its part's iterate, behind copies
/// of what is not current there: as caches do it, by pieces.
class OwnIterates::Placing {
public:
    Placing(OwnIterates& solver, const Partition& partition)
        : solver_(solver),
          partition_(partition),
          current_(
              solver.copies_.size(),
              std::vector<unsigned>(static_cast<std::size_t>(solver.pieces_.strip_count), 1U)) {}

    void add(const Task& task) {
        const int iterate = partition_.parts[static_cast<std::size_t>(task.region)].iterate;
        WEFT_ASSERT(iterate >= 0 && iterate < solver_.iterates_);
        Task own = task;
        own.body = &solver_.body_for(*task.body, iterate);
        for (Access& access : own.accesses) {
            const auto copies = index_of(access.buffer);
            if (copies == solver_.copies_.size()) continue;
            WEFT_ASSERT(access.segments == nullptr);
            bring(copies, access, iterate, own);
            access.buffer = &solver_.copies_[copies]->in(iterate);
        }
        step_.add(own);
    }

    /// What is not current in iterate 0 at the end is brought there by the part that has it.
    Step finish() {
        for (std::size_t r = 0; r < partition_.parts.size(); ++r) {
            const Part& part = partition_.parts[r];
            Task task;
            task.iteration = last_iteration_;
            task.region = static_cast<int>(r);
            for (std::size_t c = 0; c < current_.size(); ++c) {
                bring_pieces(c, kPiecesPerStrip * part.begin, kPiecesPerStrip * part.end, 0, task);
            }
        }
        step_.seal();
        return std::move(step_);
    }

private:
    std::size_t index_of(const BufferStorage* buffer) const {
        const auto& all = solver_.copies_;
        return static_cast<std::size_t>(
            std::ranges::find_if(all, [&](const auto& c) { return c->own == buffer; }) -
            all.begin());
    }

    void bring(std::size_t copies, const Access& access, int iterate, const Task& reader) {
        const int* begin = solver_.piece_begin_->data();
        const int* end = begin + solver_.pieces_.strip_count;
        // The pieces with some vertex in [access.begin, access.end); empty ones do no harm.
        const auto first = std::upper_bound(begin, end, access.begin) - begin - 1;
        const auto last = std::lower_bound(begin, end, access.end) - begin;
        bring_pieces(copies, static_cast<int>(first), static_cast<int>(last), iterate, reader);
        if (!access.writes) return;
        for (auto piece = first; piece < last; ++piece) {
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
        Copies& all = *solver_.copies_[copies];
        const auto body = static_cast<std::size_t>(from * solver_.iterates_ + to);
        const int first = solver_.pieces_.item(begin);
        const int last = solver_.pieces_.item(end);
        for (int piece = begin; piece < end; ++piece) {
            current_[copies][static_cast<std::size_t>(piece)] |= 1U << to;
        }
        if (first == last) return;
        step_.add(all.exchange[body], reader.iteration, begin, end, reader.region)
            .reads(all.in(from), first, last)
            .updates(all.in(to), first, last);
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
