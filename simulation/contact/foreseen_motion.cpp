#include "simulation/contact/foreseen_motion.h"

#include <algorithm>

#include "simulation/contact/disjoint_groups.h"
#include "simulation/families/convert.h"

namespace weft {

namespace {

constexpr int kMostChunks = 512;  ///< about; fewer, if bodies are
constexpr int kLeastPatches = 8;  ///< of a chunk
// How far a guess may be off before it is one.
constexpr double kDoubt = 0.25;  ///< of what a chunk does besides the common motion
constexpr double kSpare = 2.0;   ///< of the thickness

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Vec3 vec(const float4& v) { return to_vec3(v); }

/// The body of each vertex.
std::vector<int> bodies_of_vertices(const Model& model) {
    std::vector<int> body_of(model.positions->count());
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        const BodyRange& body = model.bodies[b];
        for (int own = 0; own < body.vertex_count; ++own) {
            body_of[at(model.vertex(body.vertex(own)))] = static_cast<int>(b);
        }
    }
    return body_of;
}

/// The chunk of each patch: some patches of one body that follow each other.
std::vector<int> chunks_of_patches(const Surface& surface) {
    const int most = std::max(kLeastPatches, surface.patch_count() / kMostChunks);
    std::vector<int> chunks;
    int first = 0;
    for (int p = 0; p < surface.patch_count(); ++p) {
        const bool is_full = p - first == most;
        if (is_full || surface.patch_body[at(p)] != surface.patch_body[at(first)]) first = p;
        const int before = chunks.empty() ? -1 : chunks.back();
        chunks.push_back(first == p ? before + 1 : before);
    }
    return chunks;
}

}  // namespace

ForeseenMotion::ForeseenMotion(const Model& model, const Surface& surface, double thickness,
                               double margin)
    : model_(model),
      thickness_(thickness),
      margin_(margin),
      substeps_(model.scene.substeps),
      body_of_(bodies_of_vertices(model)),
      chunk_of_(chunks_of_patches(surface)),
      bodies_(model.bodies.size()),
      chunks_(make_chunks(surface)),
      gained_(at(substeps_ + 1)),
      fallen_(at(substeps_ + 1)) {
    make_bodies();
}

void ForeseenMotion::make_bodies() {
    for (std::size_t v = 0; v < body_of_.size(); ++v) {
        Body& body = bodies_[at(body_of_[v])];
        body.mass += model_.masses[v];
        if ((*model_.positions)[v].w > 0.0f) continue;
        body.is_held = true;
        held_.push_back(static_cast<int>(v));
    }
}

std::vector<ForeseenMotion::Chunk> ForeseenMotion::make_chunks(const Surface& surface) const {
    std::vector<Chunk> chunks(chunk_of_.empty() ? 0 : at(chunk_of_.back() + 1));
    for (std::size_t p = 0; p < chunk_of_.size(); ++p) {
        Chunk& chunk = chunks[at(chunk_of_[p])];
        chunk.body = surface.patch_body[p];
        for (const int v : surface.hulls[static_cast<int>(p)]) {
            chunk.vertices.push_back(surface.vertices[at(v)]);
        }
    }
    for (Chunk& chunk : chunks) {
        auto& list = chunk.vertices;
        std::ranges::sort(list);
        list.erase(std::ranges::unique(list).begin(), list.end());
        chunk.falls =
            std::ranges::any_of(list, [&](int v) { return (*model_.positions)[at(v)].w > 0.0f; });
    }
    return chunks;
}

void ForeseenMotion::place(double time) {
    add_up_gravity();
    look_at_bodies(time);
    obstacles_.place(model_.convex_obstacles, time, model_.h, substeps_);
    do {
        look_at_chunks();
        find_neighbours();
    } while (share_what_leads());
    find_clearance();
}

void ForeseenMotion::lead_alike() {
    double led = 0.0;
    for (const Body& body : bodies_) led = std::max(led, body.led);
    for (Body& body : bodies_) body.led = led;
}

void ForeseenMotion::add_up_gravity() {
    for (int k = 0; k < substeps_; ++k) {
        gained_[at(k + 1)] = gained_[at(k)] + model_.h * vec((*model_.gravity)[at(k)]);
        fallen_[at(k + 1)] = fallen_[at(k)] + model_.h * gained_[at(k + 1)];
    }
}

void ForeseenMotion::look_at_bodies(double time) {
    std::vector<Vec3> momentum(bodies_.size());
    std::vector<double> left(bodies_.size(), 1.0);
    const std::vector<double> led = ways_of_held(time);
    for (std::size_t v = 0; v < body_of_.size(); ++v) {
        const std::size_t b = at(body_of_[v]);
        if (bodies_[b].is_held) continue;
        const float4& velocity = (*model_.velocities)[v];
        momentum[b] = momentum[b] + model_.masses[v] * vec(velocity);
        left[b] = static_cast<double>(velocity.w);
    }
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        Body& body = bodies_[b];
        body.led = led[b];
        body.velocity.assign(at(substeps_), {});
        if (body.is_held) continue;
        Vec3 velocity = (1.0 / body.mass) * momentum[b];
        for (int k = 0; k < substeps_; ++k) {
            velocity = velocity + model_.h * vec((*model_.gravity)[at(k)]);
            body.velocity[at(k)] = velocity;
            velocity = left[b] * velocity;
        }
    }
}

/// The farthest that the scene leads a vertex of each body in a substep [m].
std::vector<double> ForeseenMotion::ways_of_held(double time) const {
    std::vector<double> most(bodies_.size());
    if (!model_.moving_pins) return most;
    std::vector<Vec3> before(body_of_.size());
    for (const int v : held_) before[at(v)] = vec((*model_.positions)[at(v)]);
    model_.moving_pins->place_at(time, before);
    std::vector<Vec3> now = before;
    for (int k = 1; k <= substeps_; ++k) {
        model_.moving_pins->place_at(time + k * model_.h, now);
        for (const int v : held_) {
            double& body = most[at(body_of_[at(v)])];
            body = std::max(body, length(now[at(v)] - before[at(v)]));
        }
        before = now;
    }
    return most;
}

/// All that a chunk may reach in the frame is the largest where it moves with nobody.
void ForeseenMotion::look_at_chunks() {
    for (Body& body : bodies_) body.swept = {};
    for (Chunk& chunk : chunks_) {
        chunk.place = chunk.velocity = chunk.swept = {};
        for (const int v : chunk.vertices) {
            chunk.place.include(vec((*model_.positions)[at(v)]));
            chunk.velocity.include(vec((*model_.velocities)[at(v)]));
        }
        for (int k = 0; k < substeps_; ++k) chunk.swept.include(reached(chunk, k, {}));
        bodies_[at(chunk.body)].swept.include(chunk.swept);
    }
}

IntervalBox ForeseenMotion::reached(const Chunk& chunk, int substep, Vec3 together) const {
    const double led = bodies_[at(chunk.body)].led;
    IntervalBox box;
    for (const int k : {substep, substep + 1}) {
        const Vec3 fall = chunk.falls ? fallen_[at(k)] : Vec3{};
        box.include(chunk.place + (k * model_.h) * chunk.velocity + up_to(fall));
    }
    const Vec3 gain = chunk.falls ? gained_[at(substep + 1)] : Vec3{};
    const bool is_alone = together == Vec3{};
    const double besides = farthest_from(is_alone ? Vec3{} : together - gain, chunk.velocity) +
                           (is_alone ? length(gain) : 0.0);
    const double reach = model_.h * (1.0 + kDoubt * (substep + 1)) * besides;
    return box.grown(reach + (substep + 2) * led + margin_ + kSpare * thickness_);
}

IntervalBox ForeseenMotion::begin_of(const Chunk& chunk, int substep) const {
    const Vec3 fall = chunk.falls ? fallen_[at(substep)] : Vec3{};
    return chunk.place + (substep * model_.h) * chunk.velocity + IntervalBox{fall, fall};
}

/// Ascending by where chunks begin along x.
void ForeseenMotion::find_neighbours() {
    near_.clear();
    std::vector<int> order = each_alone(static_cast<int>(chunks_.size()));
    const auto begin = [&](int c) { return chunks_[at(c)].swept.low.x; };
    std::ranges::stable_sort(order, {}, begin);
    std::vector<int> groups = each_alone(static_cast<int>(bodies_.size()));
    for (auto first = order.begin(); first != order.end(); ++first) {
        const Chunk& a = chunks_[at(*first)];
        for (auto other = first + 1; other != order.end(); ++other) {
            const Chunk& b = chunks_[at(*other)];
            if (b.swept.low.x > a.swept.high.x) break;
            if (a.body == b.body || gap_between(a.swept, b.swept) > 0.0) continue;
            near_.emplace_back(*first, *other);
            join(groups, a.body, b.body);
        }
    }
    for (std::size_t b = 0; b < bodies_.size(); ++b) bodies_[b].group = groups[b];
    in_the_way_.clear();
    for (int o = 0; o < obstacles_.count(); ++o) {
        const IntervalBox box = obstacles_.box(o);
        for (int c = 0; c < static_cast<int>(chunks_.size()); ++c) {
            if (gap_between(chunks_[at(c)].swept, box) <= 0.0) in_the_way_.emplace_back(c, o);
        }
    }
}

/// Whether somebody may be pushed farther than was known.
bool ForeseenMotion::share_what_leads() {
    std::vector<double> led(bodies_.size());
    for (const Body& body : bodies_) led[at(body.group)] = std::max(led[at(body.group)], body.led);
    for (const auto& [c, o] : in_the_way_) {
        double& group = led[at(bodies_[at(chunks_[at(c)].body)].group)];
        group = std::max(group, obstacles_.way(o));
    }
    bool has_changed = false;
    for (Body& body : bodies_) {
        has_changed = has_changed || body.led < led[at(body.group)];
        body.led = led[at(body.group)];
    }
    return has_changed;
}

/// Half of the way to what the chunk will not meet.
void ForeseenMotion::find_clearance() {
    for (Chunk& chunk : chunks_) {
        chunk.clearance = IntervalBox::kFar;
        for (const Body& body : bodies_) {
            if (body.group == bodies_[at(chunk.body)].group) continue;
            const double gap = gap_between(chunk.swept, body.swept);
            chunk.clearance = std::min(chunk.clearance, 0.5 * std::max(gap, 0.0));
        }
        for (int o = 0; o < obstacles_.count(); ++o) {
            const double gap = gap_between(chunk.swept, obstacles_.box(o));
            chunk.clearance = std::min(chunk.clearance, std::max(gap, 0.0));
        }
    }
}

}  // namespace weft
