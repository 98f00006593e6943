#include "simulation/checks/step_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "runtime/executor.h"
#include "runtime/tbb/cpu_device.h"
#include "runtime/unused_memory.h"
#include "simulation/families/convert.h"
#include "simulation/model/model.h"
#include "simulation/solver/newton/refinement.h"

namespace weft {

namespace {

/// Conjugate gradients per iteration. Two iterations find most of what is left, but for steps that
/// are nearly solved already.
constexpr std::array kGradientSteps{5, 5, 10, 20};
constexpr double kEnough = 0.2;  ///< of all gains, what the last one may be

/// One substep of the scene alone. What obstacles do is in the vertices that they hold.
Scene scene_of_substep(Scene scene) {
    scene.dt /= scene.substeps;
    scene.substeps = 1;
    scene.obstacles.clear();
    if (scene.contact) scene.contact->planes = false;
    scene.solver = {};
    scene.solver.method = Method::kNewton;
    scene.solver.iterations = 1;
    return scene;
}

scheduler::Plan plan_on_one_device(const Step& step) {
    scheduler::Plan plan;
    for (std::size_t t = 0; t < step.tasks().size(); ++t) {
        const auto start = static_cast<double>(t);
        plan.placements.push_back({start, start + 1.0, 0});
    }
    plan.order_by_start(1);
    return plan;
}

}  // namespace

struct StepError::Iteration {
    explicit Iteration(Step made) : step(std::move(made)), plan(plan_on_one_device(step)) {}
    Step step;
    scheduler::Plan plan;
};

StepError::StepError(const Scene& scene, int threads) : threads_(threads) {
    threads_.execute([&] {
        model_ = std::make_unique<Model>(scene_of_substep(scene));
        newton_ = make_newton_refinement(*model_);
    });
    device_ = make_cpu_device(threads, {});
    executor_ = std::make_unique<Executor>(std::vector<Device*>{device_.get()}, newton_->bodies());
    for (std::size_t i = 0; i < kGradientSteps.size(); ++i) {
        iterations_.emplace_back(newton_->make_iteration(i == 0, kGradientSteps[i]));
    }
    for (const float4& x : model_->positions->span()) inverse_masses_.push_back(x.w);
    // What has served to set up.
    give_back(model_->triangles);
    give_back_freed();
}

StepError::~StepError() = default;

std::optional<double> StepError::of(const SubstepEnds& ends) {
    const auto estimated = estimate(ends);
    return estimated ? std::optional(estimated->relative_error) : std::nullopt;
}

std::vector<float> StepError::solved() const {
    return model_->in_scene_order(newton_->positions());
}

/// There are many frames between two estimates, and as much memory in this as in a run.
std::optional<StepEstimate> StepError::estimate(const SubstepEnds& ends) {
    start_at(ends);
    const auto estimate = estimate_begun();
    rest();
    return estimate;
}

void StepError::rest() {
    newton_->rest();
    for (auto* list : {&targets_, &reached_, &before_}) give_back(*list);
    give_back(contacts_);
    give_back_freed();
}

std::optional<StepEstimate> StepError::estimate_begun() {
    constexpr double kLostInRounding = 10.0;
    double start = 0.0;
    double reached = 0.0;
    double rounding = 0.0;
    threads_.execute([&] {
        start = energy_at(targets_);
        reached = energy_at(reached_);
        rounding = std::abs(energy_of_rounding(reached));
    });
    double minimum = refine(reached);
    if (rubs_) {
        // Friction goes by what presses at the end, for all of them.
        const double left = reached - minimum;
        threads_.execute([&] {
            start = energy_at(targets_);
            reached = energy_at(reached_);
        });
        minimum = reached - left;
    }
    const double least = kLostInRounding * rounding;
    const double left = reached - minimum;
    const double error = left / std::max(start - minimum, least);
    if (left <= least && start - minimum <= least) return StepEstimate{0.0, 0.0};
    if (!std::isfinite(error)) return std::nullopt;
    return StepEstimate{error, left};
}

/// longer: what the substep left undone is the same, so x~ is the farther away the less inertia
/// holds.
void StepError::start_at(const SubstepEnds& ends, double longer) {
    model_->place(ends.time);
    const Vec3 g = to_vec3((*model_->gravity)[0]);
    const double h = model_->h;
    const double less = longer * longer;
    inertia_ = 1.0 / (less * h * h);
    take_contacts(ends.contacts);
    targets_.resize(inverse_masses_.size());
    reached_.resize(inverse_masses_.size());
    for (std::size_t v = 0; v < reached_.size(); ++v) {
        const std::size_t own = index(model_->scene_vertex(static_cast<int>(v)));
        const auto read = [&](const std::vector<float>& xyz) {
            return Vec3{xyz[3 * own], xyz[3 * own + 1], xyz[3 * own + 2]};
        };
        const bool is_held = !ends.held.empty() && ends.held[own] != 0;
        const double w = is_held ? 0.0 : less * static_cast<double>(inverse_masses_[v]);
        const Vec3 to = read(ends.reached);
        const Vec3 fall = read(ends.positions) + h * (read(ends.velocities) + h * g);
        const Vec3 target = longer == 1.0 ? fall : to + less * (fall - to);
        reached_[v] = to_float4(to, w);
        targets_[v] = to_float4(w > 0.0 ? target : to);
    }
}

double StepError::energy_at(std::span<const float4> x) const {
    double sum = sum_of_blocks(static_cast<int>(x.size()), [&](int begin, int end) {
        double part = 0.0;
        for (auto v = static_cast<std::size_t>(begin); v < static_cast<std::size_t>(end); ++v) {
            if (reached_[v].w <= 0.0f) continue;
            const Vec3 off = to_vec3(x[v]) - to_vec3(targets_[v]);
            part += 0.5 * model_->masses[v] * inertia_ * dot(off, off);
        }
        return part;
    });
    for (const auto& family : model_->families) sum += family->total_energy(x);
    return contacts_.empty() ? sum : sum + contact_energy_at(x);
}

double StepError::contact_energy_at(std::span<const float4> x) const {
    return sum_of_blocks(static_cast<int>(contacts_.size()), [&](int begin, int end) {
        double part = 0.0;
        for (int c = begin; c < end; ++c) {
            const FrozenContact& contact = contacts_[static_cast<std::size_t>(c)];
            part += contact.energy(contact.way(x));
        }
        return part;
    });
}

void StepError::take_contacts(const std::vector<FrozenContact>& contacts) {
    contacts_ = with_corners(contacts, model_->strips.rank);
    rubs_ = std::ranges::any_of(contacts_,
                                [](const FrozenContact& c) { return c.rubbing.friction > 0.0; });
}

void StepError::press_as_at(std::span<const float4> x) {
    for (FrozenContact& contact : contacts_) contact.press = contact.force(contact.way(x));
}

/// What E has more of where coordinates are off by as much as rounding leaves them, on average.
double StepError::energy_of_rounding(double reached) const {
    constexpr float kOff = 0.25f * std::numeric_limits<float>::epsilon();
    std::vector<float4> up = reached_;
    std::vector<float4> down = reached_;
    for (std::size_t v = 0; v < up.size(); ++v) {
        const float4 x = reached_[v];
        if (x.w <= 0.0f) continue;
        const auto off = [&](std::size_t k) { return (v * 7919 + 3 * k) % 5 < 3 ? kOff : -kOff; };
        // Four times as much, so that something is left of it.
        const float4 by{4.0f * off(0) * x.x, 4.0f * off(1) * x.y, 4.0f * off(2) * x.z, 0.0f};
        up[v] = {x.x + by.x, x.y + by.y, x.z + by.z, x.w};
        down[v] = {x.x - by.x, x.y - by.y, x.z - by.z, x.w};
    }
    return (energy_at(up) + energy_at(down) - 2.0 * reached) / 32.0;
}

void StepError::begin() {
    newton_->begin(reached_, targets_, contacts_);
    for (RowTable* table : newton_->tables()) executor_->rebind(table->resized_buffers());
    if (rubs_) before_ = reached_;
}

/// What the minimum of E is, given E at x.
double StepError::refine(double reached) {
    begin();
    double least = reached;
    double last = 0.0;
    double left = 0.0;
    for (std::size_t i = 0; i < iterations_.size(); ++i) {
        executor_->run(iterations_[i].step, iterations_[i].plan, 1);
        const double gain = gain_of_iteration(least);
        least -= gain;
        // What gains fall by tells what is still to come.
        const double ratio = last > 0.0 ? std::min(gain / last, 0.5) : 0.0;
        left = gain * ratio / (1.0 - ratio);
        if (i > 0 && !(gain > kEnough * (reached - least))) break;
        last = gain;
    }
    return least - left;
}

/// With friction, by what presses where it has led to.
double StepError::gain_of_iteration(double least) {
    double from = least;
    double to = 0.0;
    threads_.execute([&] {
        if (rubs_) {
            press_as_at(newton_->positions());
            from = energy_at(before_);
        }
        to = energy_at(newton_->positions());
    });
    if (rubs_) std::ranges::copy(newton_->positions(), before_.begin());
    return std::max(from - to, 0.0);
}

/// What is soft bends far, so it takes many iterations, some of them too long steps at first, which
/// are taken back.
std::vector<float> StepError::settled(const SubstepEnds& ends, double longer, double visible) {
    constexpr int kWhiles = 8;
    constexpr int kIterations = 5;
    constexpr double kFarther = 1.1;
    start_at(ends, longer);
    begin();
    executor_->run(iterations_.front().step, iterations_.front().plan, 1);
    const Iteration& iteration = iterations_.back();
    double way = 0.0;
    for (int i = 0; i < kWhiles; ++i) {
        for (int k = 0; k < kIterations; ++k) executor_->run(iteration.step, iteration.plan, 1);
        const double before = way;
        way = farthest_way();
        if (way < std::max(visible, kFarther * before)) break;
    }
    rest();
    return solved();
}

/// Of a vertex, since the start [m].
double StepError::farthest_way() const {
    double most = 0.0;
    const auto now = newton_->positions();
    for (std::size_t v = 0; v < reached_.size(); ++v) {
        most = std::max(most, length(to_vec3(now[v]) - to_vec3(reached_[v])));
    }
    return most;
}

}  // namespace weft
