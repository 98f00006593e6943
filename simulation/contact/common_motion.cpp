#include "simulation/contact/common_motion.h"

#include <algorithm>
#include <limits>

#include "simulation/contact/disjoint_groups.h"
#include "simulation/families/convert.h"

namespace weft {

namespace {

constexpr double kWorthwhile = 0.125;  ///< of the thickness: what groups do less than, is nothing
constexpr double kNoFence = 3e38;
constexpr double kAll = std::numeric_limits<double>::infinity();  ///< of any way

std::size_t at(int i) { return static_cast<std::size_t>(i); }

bool is_moving(Vec3 velocity) { return !(velocity == Vec3{}); }

Vec3 bounded(Vec3 corner) {
    const auto near = [](double x) { return std::clamp(x, -kNoFence, kNoFence); };
    return {near(corner.x), near(corner.y), near(corner.z)};
}

}  // namespace

CommonMotion::CommonMotion(const Model& model, const Surface& surface, double thickness,
                           double margin, Buffer<int>& foresees)
    : model_(model),
      thickness_(thickness),
      substeps_(model.scene.substeps),
      foreseen_(model, surface, thickness, margin),
      foresees_(foresees),
      body_of_("contact.body_of", model.positions->count()),
      chunk_of_("contact.chunk_of", std::max(surface.patch_body.size(), std::size_t{1})),
      strays_("contact.strays", chunk_of_.count()),
      unquiet_("contact.unquiet", model.positions->count()),
      carried_("contact.carried", at(substeps_) * bodies().size()),
      fences_("contact.fences", at(substeps_) * 2 * std::max(chunks().size(), std::size_t{1})),
      borne_("contact.borne", carried_.count()) {
    std::ranges::copy(foreseen_.body_of(), body_of_.data());
    std::ranges::copy(foreseen_.chunk_of(), chunk_of_.data());
}

/// All bodies are one group.
void CommonMotion::hold() {
    foreseen_.lead_alike();
    const std::vector<Vec3> nothing(bodies().size());
    const std::vector<int> one(bodies().size());
    const std::vector<double> room(bodies().size(), foreseen_.in_the_way().empty() ? kAll : 0.0);
    for (int substep = 0; substep < substeps_; ++substep) {
        carry(substep, nothing, std::vector<double>(bodies().size()));
        open_fences(substep);
        find_borne(substep, one, room);
    }
}

std::vector<BufferStorage*> CommonMotion::placed_buffers() {
    std::vector<BufferStorage*> buffers{&carried_, &fences_, &borne_, &foresees_};
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
    foreseen_.place(time);
    Groups groups{each_alone(body_count()), std::vector<char>(bodies().size())};
    for (int substep = 0; substep < substeps_; ++substep) place_substep(substep, groups);
}

/// Groups are those that meet if all move as their groups do. Who has met does so for the rest of
/// the frame: straight on they would pass through each other. Who has come to an obstacle stays
/// there: straight on it would be behind it.
void CommonMotion::place_substep(int substep, Groups& known) {
    auto& [groups, has_arrived] = known;
    std::vector<double> room(bodies().size());
    const auto all_or_nothing = [](char arrived) { return arrived ? 0.0 : kAll; };
    std::ranges::transform(has_arrived, room.begin(), all_or_nothing);
    std::vector<Vec3> together;
    std::vector<double> back;
    std::vector<IntervalBox> boxes;
    for (bool goes_on = true; goes_on;) {
        together = common_velocities(substep, groups, room);
        back = ways_back(substep, groups, together, room);
        boxes = reached(substep, together, back);
        goes_on = block(substep, together, room);
        for (const auto& [c, d] : foreseen_.near()) {
            const int a = chunks()[at(c)].body;
            const int b = chunks()[at(d)].body;
            const bool do_move = is_moving(together[at(a)]) || is_moving(together[at(b)]);
            if (!do_move || groups[at(a)] == groups[at(b)]) continue;
            if (gap_between(boxes[at(c)], boxes[at(d)]) > 0.0) continue;
            join(groups, a, b);
            goes_on = true;
        }
    }
    carry(substep, together, back);
    find_borne(substep, groups, room);
    for (std::size_t b = 0; b < bodies().size(); ++b) {
        if (room[b] < way_of(b, substep)) has_arrived[b] = 1;
    }
    if (grouped_) grouped_->place(substep, free_groups(boxes), centres());
    const bool somebody_moves = std::ranges::any_of(together, is_moving);
    const auto is_led_alike = [&](const ForeseenMotion::Body& b) {
        return b.led == bodies().front().led;
    };
    if (somebody_moves || !std::ranges::all_of(bodies(), is_led_alike))
        build_fences(substep, split_groups(groups, together), boxes);
    else
        open_fences(substep);
}

/// Of what bodies may reach in the frame, about where they are.
std::vector<Vec3> CommonMotion::centres() const {
    std::vector<Vec3> centres;
    for (const ForeseenMotion::Body& body : bodies()) {
        centres.push_back(0.5 * (body.swept.low + body.swept.high));
    }
    return centres;
}

/// Of bodies that may meet, without those of which something is held.
std::vector<int> CommonMotion::free_groups(const std::vector<IntervalBox>& boxes) const {
    std::vector<int> groups = each_alone(body_count());
    for (const auto& [c, d] : foreseen_.near()) {
        const int a = chunks()[at(c)].body;
        const int b = chunks()[at(d)].body;
        if (groups[at(a)] == groups[at(b)] || bodies()[at(a)].is_held || bodies()[at(b)].is_held)
            continue;
        if (gap_between(boxes[at(c)], boxes[at(d)]) <= 0.0) join(groups, a, b);
    }
    return groups;
}

/// Whether somebody has less room before an obstacle than was known.
bool CommonMotion::block(int substep, const std::vector<Vec3>& together,
                         std::vector<double>& room) const {
    bool is_new = false;
    for (const auto& [c, o] : foreseen_.in_the_way()) {
        const ForeseenMotion::Chunk& chunk = chunks()[at(c)];
        if (!is_moving(together[at(chunk.body)])) continue;
        const double gap =
            gap_between(foreseen_.begin_of(chunk, substep), foreseen_.obstacles().box(substep, o));
        if (gap >= room[at(chunk.body)]) continue;
        room[at(chunk.body)] = gap;
        is_new = true;
    }
    return is_new;
}

/// Groups go as far as all of their bodies can.
std::vector<Vec3> CommonMotion::common_velocities(int substep, const std::vector<int>& groups,
                                                  const std::vector<double>& room) const {
    std::vector<ForeseenMotion::Body> sums(bodies().size());
    std::vector<Vec3> momentum(bodies().size());
    std::vector<double> least(bodies().size(), kAll);
    for (std::size_t b = 0; b < bodies().size(); ++b) {
        const std::size_t g = at(groups[b]);
        sums[g].mass += bodies()[b].mass;
        least[g] = std::min(least[g], bodies()[b].is_held ? 0.0 : room[b]);
        momentum[g] = momentum[g] + bodies()[b].mass * bodies()[b].velocity[at(substep)];
    }
    std::vector<Vec3> together(bodies().size());
    for (std::size_t b = 0; b < bodies().size(); ++b) {
        const std::size_t g = at(groups[b]);
        const Vec3 velocity = (1.0 / sums[g].mass) * momentum[g];
        const double way = model_.h * length(velocity);
        const double part = std::min(least[g] / std::max(way, 1e-300), 1.0);
        if (part * way >= kWorthwhile * thickness_) together[b] = part * velocity;
    }
    return together;
}

double CommonMotion::way_of(std::size_t body, int substep) const {
    return model_.h * length(bodies()[body].velocity[at(substep)]);
}

/// How far obstacles may push bodies back from where they move together [m].
std::vector<double> CommonMotion::ways_back(int substep, const std::vector<int>& groups,
                                            const std::vector<Vec3>& together,
                                            const std::vector<double>& room) const {
    std::vector<char> arrives(bodies().size());
    for (std::size_t b = 0; b < bodies().size(); ++b) {
        if (room[b] < way_of(b, substep)) arrives[at(groups[b])] = 1;
    }
    std::vector<double> back(bodies().size());
    for (std::size_t b = 0; b < bodies().size(); ++b) {
        if (arrives[at(groups[b])]) back[b] = model_.h * length(together[b]);
    }
    return back;
}

std::vector<IntervalBox> CommonMotion::reached(int substep, const std::vector<Vec3>& together,
                                               const std::vector<double>& back) const {
    std::vector<IntervalBox> boxes;
    for (const ForeseenMotion::Chunk& chunk : chunks()) {
        const std::size_t body = at(chunk.body);
        boxes.push_back(foreseen_.reached(chunk, substep, together[body]).grown(back[body]));
    }
    return boxes;
}

void CommonMotion::carry(int substep, const std::vector<Vec3>& together,
                         const std::vector<double>& back) {
    for (std::size_t b = 0; b < bodies().size(); ++b) {
        carried_[at(substep) * bodies().size() + b] =
            to_float4(model_.h * together[b], bodies()[b].led + back[b]);
    }
}

/// Groups of which something is held, or comes to an obstacle.
void CommonMotion::find_borne(int substep, const std::vector<int>& groups,
                              const std::vector<double>& room) {
    std::vector<float> is_borne(bodies().size());
    for (std::size_t b = 0; b < bodies().size(); ++b) {
        if (bodies()[b].is_held || room[b] < way_of(b, substep)) is_borne[at(groups[b])] = 1.0f;
    }
    for (std::size_t b = 0; b < bodies().size(); ++b) {
        borne_[at(substep) * bodies().size() + b] = is_borne[at(groups[b])];
    }
}

void CommonMotion::open_fences(int substep) {
    const std::size_t count = chunks().size();
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
    std::vector<char> is_split(bodies().size());
    for (std::size_t b = 0; b < bodies().size(); ++b) {
        const int first = bodies()[b].group;
        const bool do_move = is_moving(together[b]) || is_moving(together[at(first)]);
        if (do_move && groups[b] != groups[at(first)]) is_split[at(first)] = 1;
    }
    for (const auto& [c, o] : foreseen_.in_the_way()) {
        const ForeseenMotion::Body& body = bodies()[at(chunks()[at(c)].body)];
        if (is_moving(together[at(chunks()[at(c)].body)])) is_split[at(body.group)] = 1;
    }
    return is_split;
}

void CommonMotion::build_fences(int substep, const std::vector<char>& is_split,
                                const std::vector<IntervalBox>& boxes) {
    const std::size_t count = chunks().size();
    for (std::size_t c = 0; c < count; ++c) {
        IntervalBox fence = chunks()[c].swept.grown(chunks()[c].clearance);
        if (is_split[at(bodies()[at(chunks()[c].body)].group)]) fence = common(fence, boxes[c]);
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
