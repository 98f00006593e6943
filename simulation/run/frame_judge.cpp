#include "simulation/run/frame_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "simulation/choice/tolerance_advice.h"
#include "simulation/contact/response.h"
#include "simulation/run/live_model.h"

namespace weft {

namespace {

void record_look(const Watch::Look& look, FrameRecord& record) {
    const EnergyAccount::Entry& entry = look.entry;
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    record.strain_rms = look.strain.rms;
    record.strain_max = look.strain.most;
    record.kinetic_energy = entry.energies.kinetic;
    record.gravity_energy = entry.energies.gravity;
    record.energies = entry.energies.parts();
    record.work = entry.is_known ? entry.outside.work : unknown;
    record.dissipated = entry.is_known ? entry.dissipated() : unknown;
    record.gained = entry.gained();
}

void record_steps(const Scene& scene, FrameRecord& record) {
    record.substeps = static_cast<std::uint32_t>(scene.substeps);
    record.iterations = static_cast<std::uint32_t>(scene.solver.iterations);
}

}  // namespace

FrameJudge::FrameJudge(LiveModel& live, OnTrouble on_trouble, OnCrossing on_crossing, int threads)
    : live_(live),
      on_trouble_(on_trouble),
      choice_(live.model().scene),
      watch_(live.model(), on_trouble != OnTrouble::kIgnore, threads) {
    if (on_trouble == OnTrouble::kIgnore) return;
    const Model& model = live.model();
    samples_.emplace(model, threads);
    if (model.obstacles && model.obstacles->narrow() != nullptr) narrow_.emplace();
    if (!model.scene.contact) return;
    crossings_.emplace(model, on_crossing == OnCrossing::kWarn);
    if (!model.convex_obstacles.empty()) inside_.emplace();
}

Verdict FrameJudge::judge(const Ran& ran, FrameRecord& record) {
    const Model& model = live_.model();
    const double start = ran.frame * model.scene.dt;
    const Watch::Look look = watch_.look(model, live_.start(), start, start + model.scene.dt,
                                         live_.stored_in_contacts());
    if (look.alarm) {
        const Verdict verdict = judge(ran, *look.alarm);
        if (verdict.kind != Verdict::Kind::kKeep) return verdict;
    }
    const auto estimated = ran.may_be_sample ? estimate() : std::nullopt;
    if (estimated) {
        const Verdict verdict = judge(ran, look, *estimated);
        if (verdict.kind != Verdict::Kind::kKeep) return verdict;
    }
    const Verdict verdict = judge_obstacles(ran);
    if (verdict.kind != Verdict::Kind::kKeep) return verdict;
    if (samples_) samples_->note(model, look.strain.rms);
    watch_.accept(look, look.alarm.has_value());
    look_at_contact(ran, record);
    record_look(look, record);
    record_steps(model.scene, record);
    if (estimated) record.relative_error = estimated->relative_error;
    return {};
}

/// By what speaks against its state.
Verdict FrameJudge::judge(const Ran& ran, const Alarm& alarm) {
    if (on_trouble_ == OnTrouble::kHalve) {
        if (const auto steps = choice_.halved(live_.model().scene)) {
            troubles_.tell(
                ran.frame, alarm,
                fmt::format("done again, and all that follows, with {} substeps", steps->substeps));
            return {Verdict::Kind::kAgain, *steps};
        }
    }
    const bool is_told =
        alarm.kind == Alarm::Kind::kDoubt ||
        (alarm.kind == Alarm::Kind::kExplosion && on_trouble_ == OnTrouble::kReport);
    if (!is_told) return {Verdict::Kind::kStop, {}};
    const std::string unsolved =
        "the steps are not solved far enough, and what is seen is not believable: " + advice();
    troubles_.tell(ran.frame, alarm, alarm.remedy.empty() ? unsolved : given_up() + alarm.remedy);
    return {};
}

/// By what contact, or too few iterations, have left inside obstacles.
Verdict FrameJudge::judge_obstacles(const Ran& ran) {
    if (narrow_) {
        NarrowObstacles& narrow = *live_.model().obstacles->narrow();
        live_.executor().fetch(narrow.depths());
        const Verdict verdict = judge(ran, narrow_->look(live_.model(), narrow), *narrow_);
        if (verdict.kind != Verdict::Kind::kKeep) return verdict;
    }
    if (!inside_) return {};
    ContactResponse* contact = fetch_contact();
    const auto cuts = contact->account().cut_counts().span();
    if (std::ranges::none_of(cuts, [](int count) { return count > 0; })) return {};
    live_.executor().fetch(contact->insides()->depths());
    live_.executor().fetch(contact->insides()->obstacles());
    return judge(ran, inside_->look(live_.model(), *contact), *inside_);
}

Verdict FrameJudge::judge(const Ran& ran, const std::optional<Alarm>& alarm, InsideChecks& checks) {
    if (!alarm) return {};
    const Verdict verdict = judge(ran, *alarm);
    if (verdict.kind == Verdict::Kind::kKeep) checks.told();
    return verdict;
}

std::string FrameJudge::advice() const {
    return given_up() +
           "more substeps or iterations, or another solver, may help (docs/stability.md)";
}

/// Where there are no smaller steps to be had; else empty.
std::string FrameJudge::given_up() const {
    if (on_trouble_ != OnTrouble::kHalve) return {};
    const Scene& scene = live_.model().scene;
    return fmt::format(
        "--on-trouble halve has given up, with {} substeps, {} times as many as at first; ",
        scene.substeps, choice_.refinement(scene));
}

/// By how far its last substep was solved.
Verdict FrameJudge::judge(const Ran& ran, const Watch::Look& look, const StepEstimate& estimate) {
    const Model& model = live_.model();
    if (StepChoice::misses_tolerance(model.scene, estimate.relative_error)) {
        const auto steps = choice_.with_more_iterations(model.scene);
        if (steps) return {Verdict::Kind::kAgain, *steps};
        tell_of_tolerance(ran.frame, estimate.relative_error);
    }
    if (look.alarm) return {};
    const auto doubt = samples_->doubt(model, look, estimate);
    if (!doubt) return {};
    const Verdict verdict = judge(ran, *doubt);
    if (verdict.kind == Verdict::Kind::kKeep) samples_->told();
    return verdict;
}

/// Of the frame that has just run. None: its last substep is no sample.
std::optional<StepEstimate> FrameJudge::estimate() {
    if (!samples_ || !samples_->is_begun()) return std::nullopt;
    return samples_->end(live_.model(), live_.contacts());
}

/// Once: what would reach it is tried out, which takes a while.
void FrameJudge::tell_of_tolerance(int frame, double error) {
    if (std::exchange(tolerance_told_, true)) return;
    const Scene& scene = live_.model().scene;
    troubles_.tell_once(
        frame,
        fmt::format("solver.tolerance = {:g} is not reached: the relative error of a step is some "
                    "{:.2g} after {} iterations; {}",
                    scene.solver.tolerance, error, scene.solver.iterations,
                    advise_tolerance(scene, samples_->last())));
}

/// With what the frame tells of itself; null: there is none.
ContactResponse* FrameJudge::fetch_contact() {
    ContactResponse* contact = live_.contact();
    if (contact == nullptr) return nullptr;
    for (BufferStorage* buffer : contact->account().buffers()) live_.executor().fetch(*buffer);
    return contact;
}

/// What is not guaranteed is told, where it happens.
void FrameJudge::look_at_contact(const Ran& ran, FrameRecord& record) {
    ContactResponse* contact = fetch_contact();
    if (contact == nullptr) return;
    record.contacts = {contact->record()};
    record.contacts.front().redone = ran.redone;
    const std::string what = contact->account().trouble();
    if (!what.empty()) {
        troubles_.tell(
            ran.frame, {Alarm::Kind::kDoubt, what, {}},
            "surfaces may pass through each other there: more substeps may help (docs/contact.md)");
    }
    if (crossings_ && crossings_->wants(live_.model(), ran.frame)) look_at_crossings(ran.frame);
}

/// What nothing above foresaw is told, too: once, however much was told before.
void FrameJudge::look_at_crossings(int frame) {
    const std::string what = crossings_->look(live_.model());
    if (what.empty()) return;
    troubles_.tell_once(
        frame, fmt::format("contact: {}; they did not at the start, and contact does not part "
                           "them: more substeps may help (docs/contact.md)",
                           what));
}

std::optional<Steps> FrameJudge::steps_behind(const FrameRecord& record) const {
    return choice_.with_fewer_iterations(live_.model().scene, record.relative_error);
}

void FrameJudge::expect_other_length() {
    if (samples_) samples_->reset();
    watch_.expect_other_contacts();
}

void FrameJudge::restart(double time) {
    watch_.restart(live_.model(), time);
    if (samples_) samples_->restart(live_.model(), time);
}

void FrameJudge::resume(double time, const Checkpoint& checkpoint) {
    choice_.resume(checkpoint.failed_iterations);
    tolerance_told_ = checkpoint.tolerance_told != 0;
    watch_.restart(live_.model(), time, checkpoint.account);
    if (samples_) samples_->resume(live_.model());
}

void FrameJudge::save(Checkpoint& checkpoint) const {
    checkpoint.tolerance_told = tolerance_told_ ? 1 : 0;
    checkpoint.failed_iterations = choice_.failed_iterations();
    checkpoint.account = watch_.account().save();
}

}  // namespace weft
