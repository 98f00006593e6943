#include "simulation/families/in_double.h"
// The language layer in double precision has to come before all else. Where obstacles are is single
// precision for all solvers, and here.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdouble-promotion"
#include "kernels/obstacles/shapes.h"
#pragma GCC diagnostic pop

#include "simulation/reference/fine_run.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "runtime/error.h"
#include "simulation/families/convert.h"

namespace weft {

namespace {

kernels::nearness near_obstacle(const std::string& shape, kernels::real3 p, float4 dimensions) {
#define WEFT_TRY_SHAPE(name) \
    if (shape == #name) return kernels::near_##name(p, dimensions);
    WEFT_FOR_EACH_OBSTACLE_SHAPE(WEFT_TRY_SHAPE)
#undef WEFT_TRY_SHAPE
    throw std::logic_error("obstacle shape '" + shape + "' has no distance in double precision");
}

std::array<Vec3, kMaxCorners> corners_of(std::span<const int> vertices,
                                         const std::vector<Vec3>& x) {
    std::array<Vec3, kMaxCorners> corners;
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        corners[k] = x[static_cast<std::size_t>(vertices[k])];
    }
    return corners;
}

/// At least the largest eigenvalue's size of a symmetric matrix's block: its largest row sum.
double size_of(const Mat3& block) {
    double most = 0.0;
    for (const Vec3& row : block.rows) {
        most = std::max(most, std::abs(row.x) + std::abs(row.y) + std::abs(row.z));
    }
    return most;
}

}  // namespace

FineRun::FineRun(Model& model, int substeps)
    : model_(model),
      substeps_(substeps),
      h_(model.scene.dt / substeps),
      forces_(static_cast<std::size_t>(model.vertex_count())) {
    if (model.obstacles) obstacles_ = std::make_unique<Obstacles>(model.convex_obstacles, 1);
    for (std::size_t v = 0; v < forces_.size(); ++v) {
        const float4& x = (*model.positions)[v];
        const float4& u = (*model.velocities)[v];
        x_.push_back(to_vec3(x));
        velocities_.push_back(to_vec3(u));
        inverse_masses_.push_back(x.w > 0.0f ? 1.0 / model.masses[v] : 0.0);
        // u.w = 1 / (1 + h damping) for the model's own h.
        const double rate = model.damped ? (1.0 / static_cast<double>(u.w) - 1.0) / model.h : 0.0;
        damping_.push_back(1.0 / (1.0 + h_ * rate));
    }
    held_ = x_;
}

int FineRun::stable_substeps(const Model& model) {
    const auto count = static_cast<std::size_t>(model.vertex_count());
    std::vector<Vec3> x;
    for (std::size_t v = 0; v < count; ++v) x.push_back(to_vec3((*model.positions)[v]));
    // Gershgorin: no frequency is above the largest sum of a row of M^-1 H.
    std::vector<double> rows(count);
    for (const auto& family : model.families) {
        for (int e = 0; e < family->count(); ++e) {
            const auto vertices = family->corners(e);
            std::array<Mat3, kMaxCorners * kMaxCorners> blocks;
            family->hessian(e, corners_of(vertices, x).data(), blocks.data());
            for (std::size_t j = 0; j < vertices.size(); ++j) {
                for (std::size_t k = 0; k < vertices.size(); ++k) {
                    rows[static_cast<std::size_t>(vertices[j])] +=
                        size_of(blocks[j * vertices.size() + k]);
                }
            }
        }
    }
    double fastest = 0.0;  // [1/s^2]
    for (std::size_t v = 0; v < count; ++v) {
        if ((*model.positions)[v].w > 0.0f) fastest = std::max(fastest, rows[v] / model.masses[v]);
    }
    // h < 2 / omega is stable.
    return std::max(1, static_cast<int>(std::ceil(model.scene.dt * std::sqrt(fastest))));
}

void FineRun::advance() {
    const double start = frame_ * model_.scene.dt;
    for (int substep = 0; substep < substeps_; ++substep) step(start + substep * h_);
    ++frame_;
    constexpr double kNowhere = 1e6;  // [m]
    for (const Vec3& x : x_) {
        if (length(x) < kNowhere) continue;
        throw RunError(fmt::format(
            "the fine run diverged in frame {}; it needs more than {} substeps per frame",
            frame_ - 1, substeps_));
    }
}

void FineRun::step(double time) {
    const Vec3 gravity = model_.scene.gravity_at(time + 0.5 * h_);
    if (obstacles_) obstacles_->place(time, h_);
    for (auto& family : model_.families) family->place(time, h_);
    if (model_.moving_pins) model_.moving_pins->place_at(time + h_, held_);
    add_forces();
    for (std::size_t v = 0; v < x_.size(); ++v) {
        if (inverse_masses_[v] == 0.0) {
            x_[v] = held_[v];
            continue;
        }
        const Vec3 previous = x_[v];
        velocities_[v] = velocities_[v] + h_ * (gravity + inverse_masses_[v] * forces_[v]);
        x_[v] = previous + h_ * velocities_[v];
        if (obstacles_) push_out_of_obstacles(v, previous);
        velocities_[v] = damping_[v] * velocities_[v];
    }
}

void FineRun::add_forces() {
    std::fill(forces_.begin(), forces_.end(), Vec3{});
    for (const auto& family : model_.families) {
        for (int e = 0; e < family->count(); ++e) {
            const auto vertices = family->corners(e);
            std::array<Vec3, kMaxCorners> gradient;
            family->gradient(e, corners_of(vertices, x_).data(), gradient.data());
            for (std::size_t k = 0; k < vertices.size(); ++k) {
                Vec3& force = forces_[static_cast<std::size_t>(vertices[k])];
                force = force - gradient[k];
            }
        }
    }
}

/// As push_vertex in kernels/obstacles/contact.h, obstacle by obstacle; a push is a velocity.
void FineRun::push_out_of_obstacles(std::size_t vertex, Vec3 previous) {
    using namespace kernels;
    const float4* placement = obstacles_->placements().data();
    real3 x = to_real3(x_[vertex]);
    bool touched = false;
    for (const Obstacle& obstacle : model_.convex_obstacles) {
        const nearness near = near_obstacle(obstacle.shape, apply(placement, x), placement[6]);
        const real depth = push_depth(placement, near.distance, 1.0);
        if (depth > 0.0) {
            const real3 normal = apply_back(placement, near.normal);
            const real3 pushed = add_scaled(x, normal, depth);
            const real3 slid = slid_along(placement, pushed, to_real3(previous), normal);
            x = add_scaled(pushed, slid, -part_held(slid, depth * splat(placement[7].y)));
            touched = true;
        }
        placement += WEFT_OBSTACLE_ROWS;
    }
    if (!touched) return;
    x_[vertex] = to_vec3(x);
    velocities_[vertex] = (1.0 / h_) * (x_[vertex] - previous);
}

std::vector<float> FineRun::positions() const { return model_.in_scene_order(x_); }

}  // namespace weft
