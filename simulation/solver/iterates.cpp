#include "simulation/solver/iterates.h"

#include <algorithm>

#include "scheduler/assert.h"

namespace weft {

Iterates::Iterates(const Model& model, Solver& solver, int iterates, int slots)
    : iterates_(iterates), slots_(slots) {
    cut_pieces(model);
    for (Buffer<float4>* buffer : solver.iterate()) add_copies(*buffer);
    add_bodies(solver);
}

void Iterates::cut_pieces(const Model& model) {
    const Strips& strips = model.strips;
    const int count = strips.count();
    piece_begin_ = std::make_unique<Buffer<int>>(
        "pieces", static_cast<std::size_t>(2 * kPiecesPerStrip * count + 1));
    int* const first = piece_begin_->data();
    int* next = first;
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
    const int all = model.vertex_count();
    next = std::transform(first, next, next, [&](int begin) { return all + begin; });
    *next = 2 * all;
    WEFT_ASSERT(std::is_sorted(first, next + 1));
    pieces_ = {piece_begin_.get(), 0, 1, 2 * kPiecesPerStrip * count};
}

int Iterates::halves(std::size_t buffer) const {
    const auto all = static_cast<std::size_t>(pieces_.item(pieces_per_half()));
    return buffers_[buffer].own->count() > all ? 2 : 1;
}

void Iterates::add_copies(Buffer<float4>& own) {
    Copies& copies = buffers_.emplace_back();
    copies.own = &own;
    for (int place = 1; place < place_count(); ++place) {
        const std::string name = place < iterates_ ? "." + std::to_string(place)
                                                   : ".slot" + std::to_string(place - iterates_);
        copies.other.push_back(std::make_unique<Buffer<float4>>(own.name() + name, own.count()));
    }
}

Buffer<float4>& Iterates::in(std::size_t buffer, int place) const {
    const Copies& copies = buffers_[buffer];
    return place == 0 ? *copies.own : *copies.other[static_cast<std::size_t>(place - 1)];
}

std::size_t Iterates::index_of(const BufferStorage* buffer) const {
    return static_cast<std::size_t>(
        std::ranges::find_if(buffers_, [&](const Copies& c) { return c.own == buffer; }) -
        buffers_.begin());
}

std::pair<int, int> Iterates::pieces_with(int begin, int end) const {
    const int* first = piece_begin_->data();
    const int* last = first + pieces_.strip_count;
    return {static_cast<int>(std::upper_bound(first, last, begin) - first) - 1,
            static_cast<int>(std::lower_bound(first, last, end) - first)};
}

void Iterates::add_bodies(const Solver& solver) {
    for (const TaskBody* body : solver.bodies()) {
        const bool touches = std::ranges::any_of(body->launches, [&](const Launch& launch) {
            return std::ranges::any_of(launch.arguments, [&](const Argument& a) {
                return index_of(a.buffer) < buffer_count();
            });
        });
        if (!touches) continue;
        Elsewhere& elsewhere = elsewhere_.emplace_back(Elsewhere{body, {}});
        for (int k = 1; k < iterates_; ++k) {
            elsewhere.in.push_back(std::make_unique<TaskBody>(body_in(*body, k)));
        }
    }
}

TaskBody Iterates::body_in(const TaskBody& body, int iterate) const {
    TaskBody other = body;
    for (Launch& launch : other.launches) {
        for (Argument& argument : launch.arguments) {
            const std::size_t buffer = index_of(argument.buffer);
            if (buffer < buffer_count()) argument.buffer = &in(buffer, iterate);
        }
    }
    return other;
}

const TaskBody& Iterates::body_for(const TaskBody& body, int iterate) const {
    const auto found = std::ranges::find(elsewhere_, &body, &Elsewhere::body);
    if (iterate == 0 || found == elsewhere_.end()) return body;
    return *found->in[static_cast<std::size_t>(iterate - 1)];
}

std::vector<const TaskBody*> Iterates::other_bodies() const {
    std::vector<const TaskBody*> list;
    for (const Elsewhere& elsewhere : elsewhere_) {
        for (const auto& body : elsewhere.in) list.push_back(body.get());
    }
    return list;
}

std::vector<const Buffer<float4>*> Iterates::others() const {
    std::vector<const Buffer<float4>*> list;
    for (const Copies& copies : buffers_) {
        for (const auto& other : copies.other) list.push_back(other.get());
    }
    return list;
}

}  // namespace weft
