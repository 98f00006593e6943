#include "simulation/error_samples.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

}  // namespace

std::vector<char> held_by_obstacles(const Model& model, double time) {
    if (!model.obstacles) return {};
    std::vector<char> held(model.positions->count());
    for (const Obstacle& obstacle : model.scene.obstacles) {
        const Frame frame = obstacle.frame_at(time);
        for_each_block(model.vertex_count(), [&](int /*block*/, int begin, int end) {
            for (int v = begin; v < end; ++v) {
                const Vec3 x = to_vec3((*model.positions)[static_cast<std::size_t>(v)]);
                if (distance_to_local(obstacle, frame.to_local(x)) > obstacle.thickness + kTouch) {
                    continue;
                }
                held[index(model.scene_vertex(v))] = 1;
            }
        });
    }
    return held;
}

int frames_per_estimate(const Model& model) {
    constexpr double kShare = 0.015;  ///< of a run's time
    const SolverSettings& solver = model.scene.solver;
    const double frame = model.scene.substeps * solver.iterations * cost_of_iteration(solver);
    return static_cast<int>(std::ceil(1.0 / (kShare * frame)));
}

bool ErrorSamples::wants(const Model& model, int frame) const {
    if (model.families.empty()) return false;
    constexpr int kOften = 4;  // where iterations depend on it
    const bool has_tolerance = model.scene.solver.tolerance > 0.0;
    if (!has_tolerance && last_strain_ > kVisible && is_stretched(last_strain_, most_strain_)) {
        return true;
    }
    int every = frames_per_estimate(model);
    if (has_tolerance) every = std::min(every, kOften);
    return frame % every == every - 1 || frame == model.scene.frames - 1;
}

void ErrorSamples::begin(const Model& model, double time) {
    is_begun_ = true;
    most_strain_ = std::max(most_strain_, last_strain_);
    ends_ = SubstepEnds{model.in_scene_order(model.positions->span()),
                        model.in_scene_order(model.velocities->span()),
                        {},
                        time,
                        {}};
}

bool ErrorSamples::doubts(double strain, double energy, const StepEstimate& estimate) const {
    constexpr double kPart = 0.05;
    // As energies go with the square of strain.
    const double part = std::min(estimate.left / energy, 1.0);
    return is_stretched(strain, first_strain_) && part > kPart &&
           strain * std::sqrt(part) > kVisible;
}

std::optional<StepEstimate> ErrorSamples::end(const Model& model,
                                              std::vector<FrozenContact> contacts) {
    is_begun_ = false;
    if (!error_) error_ = std::make_unique<StepError>(model.scene, threads_);
    ends_->reached = model.in_scene_order(model.positions->span());
    ends_->held = held_by_obstacles(model, ends_->time + model.h);
    ends_->contacts = std::move(contacts);
    return error_->estimate(*ends_);
}

}  // namespace weft
