// What a simulation makes of a frame that has run: whether it stays, and what is told of it.

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "simulation/checks/crossing_checks.h"
#include "simulation/checks/diagnosis.h"
#include "simulation/checks/error_samples.h"
#include "simulation/checks/watch.h"
#include "simulation/contact/response.h"
#include "simulation/simulation.h"
#include "simulation/tolerance_advice.h"

namespace weft {

namespace {

constexpr int kMostRefinement = 16;  ///< times the substeps that a run began with
constexpr std::size_t kMostTroubles = 10;

void record(const Watch::Look& look, FrameRecord& frame) {
    const EnergyAccount::Entry& entry = look.entry;
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    frame.strain_rms = look.strain.rms;
    frame.strain_max = look.strain.most;
    frame.kinetic_energy = entry.energies.kinetic;
    frame.gravity_energy = entry.energies.gravity;
    frame.energies = entry.energies.parts();
    frame.work = entry.is_known ? entry.outside.work : unknown;
    frame.dissipated = entry.is_known ? entry.dissipated() : unknown;
}

}  // namespace

/// Looks at the frame that has just run, and writes down what there is to see.
bool Simulation::accepts(const Step& step, bool may_repeat, FrameRecord& frame) {
    const double end = time() + model_->scene.dt;
    const Watch::Look look = watch_->look(*model_, *start_, time(), end, stored_in_contacts());
    if (look.alarm && !goes_on_with(*look.alarm, step)) return false;
    const auto estimated = may_repeat ? estimate() : std::nullopt;
    if (estimated && iterates_more(estimated->relative_error)) return false;
    if (estimated && !look.alarm) {
        const auto doubt = samples_->doubt(*model_, look, *estimated);
        if (doubt && !goes_on_with(*doubt, step)) return false;
        if (doubt) samples_->told();
    }
    if (samples_) samples_->note(*model_, look.strain.rms);
    watch_->accept(look, look.alarm.has_value());
    look_at_contact(frame);
    record(look, frame);
    frame.substeps = static_cast<std::uint32_t>(model_->scene.substeps);
    frame.iterations = static_cast<std::uint32_t>(model_->scene.solver.iterations);
    if (estimated) frame.relative_error = estimated->relative_error;
    return true;
}

/// Of the frame that has just run. None: its last substep is no sample.
std::optional<StepEstimate> Simulation::estimate() {
    if (!samples_ || !samples_->is_begun()) return std::nullopt;
    return samples_->end(*model_, contacts());
}

/// Whether the frame is to be done again with more iterations.
bool Simulation::iterates_more(double error) {
    const SolverSettings& solver = model_->scene.solver;
    if (solver.tolerance == 0.0 || error <= solver.tolerance) return false;
    if (solver.iterations >= most_iterations_) {
        tell_of_tolerance(error);
        return false;
    }
    failed_iterations_ = std::max(failed_iterations_, solver.iterations);
    restore(*start_);
    set_steps(model_->scene.substeps, std::min(most_iterations_, 2 * solver.iterations));
    start_ = snapshot();
    snapshot_.reset();
    return true;
}

/// Frames to come take fewer iterations where far fewer seem to do, and did not fail before.
void Simulation::iterate_less(double error) {
    constexpr double kFarBelow = 0.125;
    const SolverSettings& solver = model_->scene.solver;
    const int half = (solver.iterations + 1) / 2;
    if (solver.tolerance == 0.0 || half == solver.iterations || half <= failed_iterations_) return;
    if (error <= kFarBelow * solver.tolerance) set_steps(model_->scene.substeps, half);
}

/// Once: what would reach it is tried out, which takes a while.
void Simulation::tell_of_tolerance(double error) {
    if (std::exchange(tolerance_told_, true)) return;
    const SolverSettings& solver = model_->scene.solver;
    troubles_.push_back(
        {frame_,
         fmt::format("solver.tolerance = {:g} is not reached: the relative error of a step is some "
                     "{:.2g} after {} iterations; {}",
                     solver.tolerance, error, solver.iterations,
                     advise_tolerance(model_->scene, samples_->last())),
         false});
}

StoredInContacts Simulation::stored_in_contacts() {
    ContactResponse* contact = solver_->contact();
    if (contact == nullptr) return {};
    run_->executor().fetch(contact->energy().energies());
    return contact->energy().stored();
}

std::vector<FrozenContact> Simulation::contacts() {
    ContactResponse* contact = solver_->contact();
    if (contact == nullptr) return {};
    for (BufferStorage* buffer : contact->rows().buffers()) run_->executor().fetch(*buffer);
    return with_corners(contact->frozen(), model_->strips.order);
}

/// What is not guaranteed is told, where it happens.
void Simulation::look_at_contact(FrameRecord& frame) {
    ContactResponse* contact = solver_->contact();
    if (contact == nullptr) return;
    run_->executor().fetch(contact->cut_counts());
    run_->executor().fetch(contact->cut_ways());
    run_->executor().fetch(contact->nearest());
    frame.contacts = {contact->account()};
    frame.contacts.front().redone = redone_;
    const std::string what = contact->trouble();
    if (!what.empty()) {
        tell(
            {Alarm::Kind::kDoubt, what, {}},
            "surfaces may pass through each other there: more substeps may help (docs/contact.md)");
    }
    if (crossings_ && crossings_->wants(*model_, frame_)) look_at_crossings();
}

/// What nothing above foresaw is told, too: once, however much was told before.
void Simulation::look_at_crossings() {
    const std::string what = crossings_->look(*model_);
    if (what.empty()) return;
    troubles_.push_back(
        {frame_,
         fmt::format("contact: {}; they did not at the start, and contact does not part them: "
                     "more substeps may help (docs/contact.md)",
                     what),
         false});
}

bool Simulation::goes_on_with(const Alarm& alarm, const Step& step) {
    if (options_.on_trouble == OnTrouble::kHalve && halve(alarm)) return false;
    const bool is_told =
        alarm.kind == Alarm::Kind::kDoubt ||
        (alarm.kind == Alarm::Kind::kExplosion && options_.on_trouble == OnTrouble::kReport);
    if (!is_told) {
        restore(*start_);
        diagnose_frame(frame_, *start_, *watch_, step, *model_, *solver_);
    }
    tell(alarm,
         "the steps are not solved far enough, and what is seen is not believable: more substeps "
         "or iterations, or another solver, may help (docs/stability.md)");
    return true;
}

/// Whether the frame is to be done again with steps of half the size.
bool Simulation::halve(const Alarm& alarm) {
    const int substeps = 2 * model_->scene.substeps;
    if (substeps > kMostRefinement * first_substeps_) return false;
    restore(*start_);
    set_steps(substeps, model_->scene.solver.iterations);
    start_ = snapshot();
    snapshot_.reset();
    tell(alarm, fmt::format("done again, and all that follows, with {} substeps", substeps));
    return true;
}

void Simulation::tell(const Alarm& alarm, const std::string& what) {
    if (troubles_.size() >= kMostTroubles) return;
    std::string text = fmt::format("{}; {}", alarm.what, what);
    if (troubles_.size() + 1 == kMostTroubles) text += "; what comes after this is not told";
    troubles_.push_back({frame_, text, alarm.kind != Alarm::Kind::kDoubt});
}

}  // namespace weft
