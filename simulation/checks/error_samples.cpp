#include "simulation/checks/error_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulation/checks/borne_bodies.h"
#include "simulation/families/convert.h"
#include "simulation/model/model.h"

namespace weft {

namespace {

constexpr double kVisible = 0.05;  ///< of strain
constexpr double kTouch = 1e-4;    ///< [m] from where an obstacle keeps a vertex

/// What an iteration takes, as a part of what an estimate takes.
double cost_of_iteration(const SolverSettings& solver) {
    switch (solver.method) {
        case Method::kXpbd:
            return 0.015;
        case Method::kVbd:
        case Method::kSosd:
            return 0.03;
        case Method::kJpgd:
            return 0.02;
        case Method::kNewton:
            return 0.4;
    }
    return 0.015;
}

/// Further stretched than what there is already.
bool is_stretched(double strain, double known) { return strain > 1.5 * known; }

/// An estimate is made in the last one of so many frames.
int frames_per_estimate(const Model& model) {
    constexpr double kShare = 0.015;  ///< of a run's time
    const SolverSettings& solver = model.scene.solver;
    const double frame = model.scene.substeps * solver.iterations * cost_of_iteration(solver);
    return static_cast<int>(std::ceil(1.0 / (kShare * frame)));
}

}  // namespace

std::vector<char> held_by_obstacles(const Model& model, double time) {
    if (!model.obstacles) return {};
    std::vector<char> held(model.positions->count());
    for (std::size_t o = 0; o < model.convex_obstacles.size(); ++o) {
        const Frame frame = model.convex_obstacles[o].frame_at(time);
        for_each_block(model.vertex_count(), [&](int /*block*/, int begin, int end) {
            for (int v = begin; v < end; ++v) {
                if (!model.obstacles->touches(o, frame, v, model.positions->span(), kTouch))
                    continue;
                held[index(model.scene_vertex(v))] = 1;
            }
        });
    }
    return held;
}

ErrorSamples::ErrorSamples(const Model& model, int threads) : threads_(threads), motion_(model) {
    restart(model, 0.0);
}

void ErrorSamples::restart(const Model& model, double time) {
    start_ = time;
    motion_ = UnsolvedMotion(model);
    noted_ = places_looked_at_ = 0;
    first_strain_ = last_strain_ = most_strain_ = model.edges->strain(model.positions->span()).rms;
}

void ErrorSamples::resume(const Model& model) {
    last_strain_ = most_strain_ = model.edges->strain(model.positions->span()).rms;
    motion_.resume(model);
}

void ErrorSamples::note(const Model& model, double strain) {
    last_strain_ = strain;
    ++noted_;
    motion_.note(model);
    ends_.reset();
}

bool ErrorSamples::wants(const Model& model, int frame) const {
    if (model.families.empty()) return false;
    constexpr int kOften = 4;  // where iterations depend on it
    const bool has_tolerance = model.scene.solver.tolerance > 0.0;
    if (!has_tolerance && last_strain_ > kVisible && is_stretched(last_strain_, most_strain_)) {
        return true;
    }
    const int left = model.scene.frames - 1 - frame;
    if (left == 0) return true;
    const int every = frames_per_estimate(model);
    if (has_tolerance && every > kOften) return frame % kOften == kOften - 1;
    // Not shortly before the last frame, which is estimated anyhow.
    return frame % every == every - 1 && (left < 0 || 2 * left >= every);
}

void ErrorSamples::begin(const Model& model, double time) {
    is_begun_ = true;
    ends_ = SubstepEnds{model.in_scene_order(model.positions->span()),
                        model.in_scene_order(model.velocities->span()),
                        {},
                        time,
                        {}};
}

std::optional<Alarm> ErrorSamples::doubt(const Model& model, const Watch::Look& look,
                                         const StepEstimate& estimate) {
    auto alarm = doubt_of_strain(look, estimate);
    if (alarm || is_told_ || is_early(model)) return alarm;
    alarm = doubt_of_motion(model, look.strain.rms);
    if (!alarm) alarm = doubt_of_led_solids(model, estimate.relative_error);
    return alarm ? alarm : doubt_of_places(model);
}

/// What begins taut gives way first, and moves then; few steps are all the way that there is. And
/// something that falls has to have fallen by a good part of the size of everything.
bool ErrorSamples::is_early(const Model& model) const {
    constexpr double kFewSteps = 10.0;
    constexpr double kFallen = 0.25;
    const double end = ends_->time + model.h;
    const double time = end - start_;
    const double fallen = 0.5 * length(model.scene.gravity_at(end)) * time * time;
    return time < kFewSteps * model.h || fallen < kFallen * motion_.size();
}

std::optional<Alarm> ErrorSamples::doubt_of_strain(const Watch::Look& look,
                                                   const StepEstimate& estimate) const {
    constexpr double kPart = 0.05;
    const double strain = look.strain.rms;
    const double energy = look.entry.energies.strain();
    // As energies go with the square of strain.
    const double part = std::min(estimate.left / energy, 1.0);
    const bool is_doubted =
        is_stretched(strain, first_strain_) && part > kPart && strain * std::sqrt(part) > kVisible;
    if (!is_doubted) return std::nullopt;
    return Alarm{
        Alarm::Kind::kDoubt,
        fmt::format("edges are strained by {:.3g} % RMS in steps that are hardly solved ({:.2g} "
                    "J of strain, of which a single step leaves {:.2g} J too much)",
                    100.0 * strain, energy, estimate.left),
        {}};
}

std::optional<Alarm> ErrorSamples::doubt_of_motion(const Model& model, double strain) const {
    // xpbd's contacts are constraints of their own, which E does not have.
    const bool is_comparable = !model.scene.contact || model.scene.solver.method != Method::kXpbd;
    const auto found = is_comparable ? motion_.find(model, error_->solved()) : std::nullopt;
    if (found) {
        const BodyRange& body = model.bodies[found->body];
        return Alarm{Alarm::Kind::kDoubt,
                     fmt::format("{} '{}' has moved by {:.2g} m since the start (RMS), of which a "
                                 "single step would take back {:.2g} m if it were solved",
                                 body.kind, body.name, found->moved, found->undone),
                     {}};
    }
    // What pins twist is strained by them, however little it moves.
    if (model.moving_pins || !is_stretched(strain, first_strain_)) return std::nullopt;
    std::vector<float4> solved(model.positions->count());
    model.from_scene_order(error_->solved(), solved);
    const double solved_strain = model.edges->strain(solved).rms;
    const auto moved = motion_.find(model, strain, solved_strain);
    if (!moved) return std::nullopt;
    return Alarm{
        Alarm::Kind::kDoubt,
        fmt::format("everything has moved by {:.2g} m since the start (RMS), and edges are "
                    "strained by {:.2g} % RMS, where a single step would leave {:.2g} % if "
                    "it were solved: that can be all of the motion",
                    *moved, 100.0 * strain, 100.0 * solved_strain),
        {}};
}

/// Where pins lead solids, strain and motion do not tell whether steps are solved: what is twisted
/// has gone far, and is strained by the pins. The error itself does, of what descends the step's
/// energy: blocks twisted at a ratio of 0.495 by 8 iterations of 4 ms sag by 15 to 26 times what
/// they should, at errors of 0.8 and more; at 0.4, by 2 iterations, by 6 and 23 times at 0.55 and
/// 0.89, and by 4 and 8 by 3.9 and 1.04 times at 0.32 and 0.05.
std::optional<Alarm> ErrorSamples::doubt_of_led_solids(const Model& model,
                                                       double relative_error) const {
    constexpr double kUnsolved = 0.6;
    const Scene& scene = model.scene;
    const bool are_solids = !scene.solids.empty() && scene.cloths.empty() && !scene.contact;
    if (!model.moving_pins || !are_solids) return std::nullopt;
    if (scene.solver.method == Method::kXpbd || relative_error < kUnsolved) return std::nullopt;
    return Alarm{Alarm::Kind::kDoubt,
                 fmt::format("solids are led by pins in steps that are hardly solved: a relative "
                             "error of {:.2g}, where 1 is no better than motion without material",
                             relative_error),
                 {}};
}

/// Where bodies would be, if what the step leaves undone acted on. That takes several times what an
/// estimate takes, so it is looked at in a few frames only, and in the last one.
std::optional<Alarm> ErrorSamples::doubt_of_places(const Model& model) {
    constexpr int kSeldom = 4;
    constexpr int kFirst = 100;
    constexpr double kPeriods = 3.0;
    constexpr double kHidden = 0.3;  // of what is told
    const double end = ends_->time + model.h;
    const bool is_last = end + 0.5 * model.h > model.scene.frames * model.scene.dt;
    if (!is_last && noted_ < std::max(kFirst, kSeldom * places_looked_at_)) return std::nullopt;
    const double g = length(model.scene.gravity_at(end));
    const std::vector<char> borne = borne_bodies(model, *ends_);
    const auto pushed = motion_.pushed(model, error_->solved(), borne, g * model.h * model.h);
    if (!pushed) return std::nullopt;
    places_looked_at_ = noted_;
    // What sags by that far swings in about sqrt(way / g).
    const double time = kPeriods * std::sqrt(pushed->most / g);
    const auto settled = error_->settled(*ends_, std::max(1.0, time / model.h),
                                         kHidden * UnsolvedMotion::hidden(pushed->least));
    const auto found = motion_.find_misplaced(model, settled, borne, g);
    if (!found) return std::nullopt;
    const BodyRange& body = model.bodies[found->body];
    return Alarm{
        Alarm::Kind::kDoubt,
        fmt::format("the middle of {} '{}' has been {:.2g} m from its start, and is {:.2g} "
                    "m off by what each step leaves undone",
                    body.kind, body.name, found->moved, found->undone),
        {}};
}

std::optional<StepEstimate> ErrorSamples::end(const Model& model,
                                              std::vector<FrozenContact> contacts) {
    is_begun_ = false;
    // Not before: a frame that lacked room begins once more, and is wanted still.
    most_strain_ = std::max(most_strain_, last_strain_);
    if (!error_) error_ = std::make_unique<StepError>(model.scene, threads_);
    ends_->reached = model.in_scene_order(model.positions->span());
    ends_->held = held_by_obstacles(model, ends_->time + model.h);
    ends_->contacts = std::move(contacts);
    return error_->estimate(*ends_);
}

}  // namespace weft
