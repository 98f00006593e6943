#include "simulation/contact/common_motion.h"

#include <algorithm>
#include <numeric>

#include "simulation/families/convert.h"

namespace weft {

namespace {

constexpr double kWorthwhile = 0.125;  ///< of the thickness: what groups do less than, is nothing
constexpr int kMostChunks = 512;       ///< about; fewer, if bodies are
constexpr int kLeastPatches = 8;       ///< of a chunk
// How far a guess may be off before it is one.
constexpr double kDoubt = 0.25;  ///< of what a chunk does besides the common motion
constexpr double kSpare = 2.0;   ///< of the thickness

constexpr double kNoFence = 3e38;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Vec3 vec(const float4& v) { return to_vec3(v); }

/// Groups by the lowest number of their members.
void join(std::vector<int>& groups, int a, int b) {
    const int low = std::min(groups[at(a)], groups[at(b)]);
    const int high = std::max(groups[at(a)], groups[at(b)]);
    std::ranges::replace(groups, high, low);
}

std::vector<int> each_alone(int count) {
    std::vector<int> groups(at(count));
    std::iota(groups.begin(), groups.end(), 0);
    return groups;
}

bool is_moving(Vec3 velocity) { return !(velocity == Vec3{}); }

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

Vec3 bounded(Vec3 corner) {
    const auto near = [](double x) { return std::clamp(x, -kNoFence, kNoFence); };
    return {near(corner.x), near(corner.y), near(corner.z)};
}

}  // namespace

CommonMotion::CommonMotion(const Model& model, const Surface& surface, double thickness,
                           double margin, Buffer<int>& foresees)
    : model_(model),
      thickness_(thickness),
      margin_(margin),
      substeps_(model.scene.substeps),
      bodies_(model.bodies.size()),
      chunks_(make_chunks(model, surface, chunks_of_patches(surface))),
      gained_(at(substeps_ + 1)),
      fallen_(at(substeps_ + 1)),
      foresees_(foresees),
      body_of_("contact.body_of", model.positions->count()),
      chunk_of_("contact.chunk_of", std::max(surface.patch_body.size(), std::size_t{1})),
      strays_("contact.strays", chunk_of_.count()),
      unquiet_("contact.unquiet", model.positions->count()),
      carried_("contact.carried", at(substeps_) * bodies_.size()),
      fences_("contact.fences", at(substeps_) * 2 * std::max(chunks_.size(), std::size_t{1})) {
    std::ranges::copy(bodies_of_vertices(model), body_of_.data());
    std::ranges::copy(chunks_of_patches(surface), chunk_of_.data());
    make_bodies();
}

void CommonMotion::make_bodies() {
    for (std::size_t v = 0; v < body_of_.count(); ++v) {
        Body& body = bodies_[at(body_of_[v])];
        body.mass += model_.masses[v];
        if ((*model_.positions)[v].w > 0.0f) continue;
        body.is_held = true;
        held_.push_back(static_cast<int>(v));
    }
}

std::vector<CommonMotion::Chunk> CommonMotion::make_chunks(const Model& model,
                                                           const Surface& surface,
                                                           const std::vector<int>& chunk_of) {
    std::vector<Chunk> chunks(chunk_of.empty() ? 0 : at(chunk_of.back() + 1));
    for (std::size_t p = 0; p < chunk_of.size(); ++p) {
        Chunk& chunk = chunks[at(chunk_of[p])];
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
            std::ranges::any_of(list, [&](int v) { return (*model.positions)[at(v)].w > 0.0f; });
    }
    return chunks;
}

/// All bodies are one group.
void CommonMotion::hold() {
    double led = 0.0;
    for (const Body& body : bodies_) led = std::max(led, body.led);
    for (Body& body : bodies_) body.led = led;
    const std::vector<Vec3> nothing(bodies_.size());
    for (int substep = 0; substep < substeps_; ++substep) {
        carry(substep, nothing);
        open_fences(substep);
    }
}

std::vector<BufferStorage*> CommonMotion::placed_buffers() {
    std::vector<BufferStorage*> buffers{&carried_, &fences_, &foresees_};
    if (!grouped_) return buffers;
    for (BufferStorage* buffer : grouped_->buffers()) buffers.push_back(buffer);
    return buffers;
}

BodyGroups& CommonMotion::group(std::vector<std::vector<int>> parts) {
    grouped_ = std::make_unique<BodyGroups>(substeps_, std::move(parts));
    return *grouped_;
}

void CommonMotion::place(double time) {
    foresees_[0] = 1;
    add_up_gravity();
    look_at_bodies(time);
    obstacles_.place(model_.convex_obstacles, time, model_.h, substeps_);
    do {
        look_at_chunks();
        find_neighbours();
    } while (share_what_leads());
    find_clearance();
    Groups groups{each_alone(body_count()), std::vector<char>(bodies_.size())};
    for (int substep = 0; substep < substeps_; ++substep) place_substep(substep, groups);
}

void CommonMotion::add_up_gravity() {
    for (int k = 0; k < substeps_; ++k) {
        gained_[at(k + 1)] = gained_[at(k)] + model_.h * vec((*model_.gravity)[at(k)]);
        fallen_[at(k + 1)] = fallen_[at(k)] + model_.h * gained_[at(k + 1)];
    }
}

void CommonMotion::look_at_bodies(double time) {
    std::vector<Vec3> momentum(bodies_.size());
    std::vector<double> left(bodies_.size(), 1.0);
    const std::vector<double> led = ways_of_held(time);
    for (std::size_t v = 0; v < body_of_.count(); ++v) {
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
std::vector<double> CommonMotion::ways_of_held(double time) const {
    std::vector<double> most(bodies_.size());
    if (!model_.moving_pins) return most;
    std::vector<Vec3> before(body_of_.count());
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
void CommonMotion::look_at_chunks() {
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

/// What a chunk and its boxes may reach in a substep, if its group moves with `together`.
IntervalBox CommonMotion::reached(const Chunk& chunk, int substep, Vec3 together) const {
    const double led = bodies_[at(chunk.body)].led;
    IntervalBox box;
    for (const int k : {substep, substep + 1}) {
        const Vec3 fall = chunk.falls ? fallen_[at(k)] : Vec3{};
        box.include(chunk.place + (k * model_.h) * chunk.velocity + up_to(fall));
    }
    const Vec3 gain = chunk.falls ? gained_[at(substep + 1)] : Vec3{};
    const bool is_alone = !is_moving(together);
    const double besides = farthest_from(is_alone ? Vec3{} : together - gain, chunk.velocity) +
                           (is_alone ? length(gain) : 0.0);
    const double reach = model_.h * (1.0 + kDoubt * (substep + 1)) * besides;
    return box.grown(reach + (substep + 2) * led + margin_ + kSpare * thickness_);
}

/// Ascending by where chunks begin along x.
void CommonMotion::find_neighbours() {
    near_.clear();
    std::vector<int> order = each_alone(chunk_count());
    const auto begin = [&](int c) { return chunks_[at(c)].swept.low.x; };
    std::ranges::stable_sort(order, {}, begin);
    std::vector<int> groups = each_alone(body_count());
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
        for (int c = 0; c < chunk_count(); ++c) {
            if (gap_between(chunks_[at(c)].swept, box) <= 0.0) in_the_way_.emplace_back(c, o);
        }
    }
}

/// Whether somebody may be pushed farther than was known.
bool CommonMotion::share_what_leads() {
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
void CommonMotion::find_clearance() {
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

/// Groups are those that meet if all move as their groups do. Who has met does so for the rest of
/// the frame: straight on they would pass through each other.
void CommonMotion::place_substep(int substep, Groups& known) {
    auto& [groups, is_blocked] = known;
    std::vector<Vec3> together;
    std::vector<IntervalBox> boxes;
    for (bool goes_on = true; goes_on;) {
        together = common_velocities(substep, groups, is_blocked);
        boxes = reached(substep, together);
        goes_on = block(substep, together, boxes, is_blocked);
        for (const auto& [c, d] : near_) {
            const int a = chunks_[at(c)].body;
            const int b = chunks_[at(d)].body;
            const bool do_move = is_moving(together[at(a)]) || is_moving(together[at(b)]);
            if (!do_move || groups[at(a)] == groups[at(b)]) continue;
            if (gap_between(boxes[at(c)], boxes[at(d)]) > 0.0) continue;
            join(groups, a, b);
            goes_on = true;
        }
    }
    carry(substep, together);
    if (grouped_) grouped_->place(substep, free_groups(boxes));
    const bool somebody_moves = std::ranges::any_of(together, is_moving);
    const auto is_led_alike = [&](const Body& b) { return b.led == bodies_.front().led; };
    if (somebody_moves || !std::ranges::all_of(bodies_, is_led_alike))
        build_fences(substep, split_groups(groups, together), boxes);
    else
        open_fences(substep);
}

/// Of bodies that may meet, without those of which something is held.
std::vector<int> CommonMotion::free_groups(const std::vector<IntervalBox>& boxes) const {
    std::vector<int> groups = each_alone(body_count());
    for (const auto& [c, d] : near_) {
        const int a = chunks_[at(c)].body;
        const int b = chunks_[at(d)].body;
        if (groups[at(a)] == groups[at(b)] || bodies_[at(a)].is_held || bodies_[at(b)].is_held)
            continue;
        if (gap_between(boxes[at(c)], boxes[at(d)]) <= 0.0) join(groups, a, b);
    }
    return groups;
}

/// Whether somebody moves into an obstacle who was not known to do so.
bool CommonMotion::block(int substep, const std::vector<Vec3>& together,
                         const std::vector<IntervalBox>& boxes,
                         std::vector<char>& is_blocked) const {
    bool is_new = false;
    for (const auto& [c, o] : in_the_way_) {
        const std::size_t body = at(chunks_[at(c)].body);
        if (!is_moving(together[body])) continue;
        if (gap_between(boxes[at(c)], obstacles_.box(substep, o)) > 0.0) continue;
        is_blocked[body] = 1;
        is_new = true;
    }
    return is_new;
}

std::vector<Vec3> CommonMotion::common_velocities(int substep, const std::vector<int>& groups,
                                                  const std::vector<char>& is_blocked) const {
    std::vector<Body> sums(bodies_.size());
    std::vector<Vec3> momentum(bodies_.size());
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        Body& sum = sums[at(groups[b])];
        sum.mass += bodies_[b].mass;
        sum.is_held = sum.is_held || bodies_[b].is_held || is_blocked[b] != 0;
        momentum[at(groups[b])] =
            momentum[at(groups[b])] + bodies_[b].mass * bodies_[b].velocity[at(substep)];
    }
    std::vector<Vec3> together(bodies_.size());
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        const std::size_t g = at(groups[b]);
        const Vec3 velocity = (1.0 / sums[g].mass) * momentum[g];
        const bool counts = model_.h * length(velocity) >= kWorthwhile * thickness_;
        if (counts && !sums[g].is_held) together[b] = velocity;
    }
    return together;
}

std::vector<IntervalBox> CommonMotion::reached(int substep,
                                               const std::vector<Vec3>& together) const {
    std::vector<IntervalBox> boxes;
    for (const Chunk& chunk : chunks_) {
        boxes.push_back(reached(chunk, substep, together[at(chunk.body)]));
    }
    return boxes;
}

void CommonMotion::carry(int substep, const std::vector<Vec3>& together) {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        carried_[at(substep) * bodies_.size() + b] =
            to_float4(model_.h * together[b], bodies_[b].led);
    }
}

void CommonMotion::open_fences(int substep) {
    const std::size_t count = chunks_.size();
    for (std::size_t c = 0; c < count; ++c) {
        const std::size_t low = 2 * at(substep) * count + c;
        fences_[low] = to_float4({-kNoFence, -kNoFence, -kNoFence});
        fences_[low + count] = to_float4({kNoFence, kNoFence, kNoFence});
    }
}

/// Of bodies that may meet in the frame: whether some move, and not as the others, or the obstacles
/// that they may meet.
std::vector<char> CommonMotion::split_groups(const std::vector<int>& groups,
                                             const std::vector<Vec3>& together) const {
    std::vector<char> is_split(bodies_.size());
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        const int first = bodies_[b].group;
        const bool do_move = is_moving(together[b]) || is_moving(together[at(first)]);
        if (do_move && groups[b] != groups[at(first)]) is_split[at(first)] = 1;
    }
    for (const auto& [c, o] : in_the_way_) {
        const Body& body = bodies_[at(chunks_[at(c)].body)];
        if (is_moving(together[at(chunks_[at(c)].body)])) is_split[at(body.group)] = 1;
    }
    return is_split;
}

void CommonMotion::build_fences(int substep, const std::vector<char>& is_split,
                                const std::vector<IntervalBox>& boxes) {
    const std::size_t count = chunks_.size();
    for (std::size_t c = 0; c < count; ++c) {
        IntervalBox fence = chunks_[c].swept.grown(chunks_[c].clearance);
        if (is_split[at(bodies_[at(chunks_[c].body)].group)]) fence = common(fence, boxes[c]);
        const std::size_t low = 2 * at(substep) * count + c;
        fences_[low] = to_float4(bounded(fence.low));
        fences_[low + count] = to_float4(bounded(fence.high));
    }
}

bool CommonMotion::revise() {
    const auto is_one = [](int flag) { return flag != 0; };
    const bool somebody_strayed = std::ranges::any_of(strays_.span(), is_one);
    const bool is_loose = foresees_[0] != 0 && std::ranges::any_of(unquiet_.span(), is_one);
    if (!somebody_strayed && !is_loose) return false;
    if (somebody_strayed) hold();
    foresees_[0] = 0;
    return true;
}

}  // namespace weft
