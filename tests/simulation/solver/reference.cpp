#include "tests/simulation/solver/reference.h"

#include <algorithm>

#include "simulation/model/convert.h"

namespace weft::test {

namespace {

/// Elements of a phase in their order.
template <class Project>
void sweep(const Elements& elements, Phase phase, Project project) {
    const Segments& s = elements.segments(phase);
    for (int item = s.item(0); item < s.item(s.strip_count); ++item) project(item);
}

struct Surface {
    double distance;
    Vec3 normal;
};

/// Sphere and plane, in their local frame.
Surface nearest(const Obstacle& obstacle, Vec3 p) {
    if (obstacle.shape == "plane") return {p.y, {0.0, 1.0, 0.0}};
    return {length(p) - obstacle.dimensions[0], normalized(p)};
}

}  // namespace

ReferenceXpbd::ReferenceXpbd(const Model& model) : model_(model) {
    for (std::size_t i = 0; i < model.masses.size(); ++i) {
        const float4& position = (*model.positions)[i];
        x.push_back(to_vec3(position));
        v.push_back(to_vec3((*model.velocities)[i]));
        inverse_mass_.push_back(position.w > 0.0f ? 1.0 / model.masses[i] : 0.0);
        decay_.push_back(static_cast<double>((*model.velocities)[i].w));
    }
}

void ReferenceXpbd::substep(double time) {
    const double h = model_.h;
    const Vec3 gravity = model_.scene.gravity_at(time + 0.5 * h);
    previous_ = x;
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (inverse_mass_[i] > 0.0) x[i] = x[i] + h * (v[i] + h * gravity);
    }
    const auto count = [](const auto& kind) {
        return kind ? static_cast<std::size_t>(kind->elements.count()) : 0;
    };
    spring_multipliers_.assign(count(model_.springs), 0.0);
    hinge_multipliers_.assign(count(model_.hinges), 0.0);
    for (int iteration = 0; iteration < model_.scene.solver.iterations; ++iteration) {
        for (const Phase phase : {kSeamPhase, kInnerPhase}) {
            sweep(model_.springs->elements, phase, [&](int spring) { project_spring(spring); });
            if (!model_.hinges) continue;
            sweep(model_.hinges->elements, phase, [&](int hinge) { project_hinge(hinge); });
        }
        for (const Obstacle& obstacle : model_.scene.obstacles) collide(obstacle, time);
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
        v[i] = inverse_mass_[i] > 0.0 ? (decay_[i] / h) * (x[i] - previous_[i]) : Vec3{};
    }
}

void ReferenceXpbd::project_spring(int spring) {
    const auto ends = model_.springs->elements.vertices_of(spring);
    const auto a = static_cast<std::size_t>(ends[0]);
    const auto b = static_cast<std::size_t>(ends[1]);
    const double alpha = 1.0 / (model_.springs->stiffness(spring) * model_.h * model_.h);
    const Vec3 along = x[a] - x[b];
    const double c = length(along) - model_.springs->rest_length(spring);
    double& lambda = spring_multipliers_[static_cast<std::size_t>(spring)];
    const double change = (-c - alpha * lambda) / (inverse_mass_[a] + inverse_mass_[b] + alpha);
    lambda += change;
    const Vec3 direction = normalized(along);
    x[a] = x[a] + (inverse_mass_[a] * change) * direction;
    x[b] = x[b] - (inverse_mass_[b] * change) * direction;
}

void ReferenceXpbd::project_hinge(int hinge) {
    const auto corners = model_.hinges->elements.vertices_of(hinge);
    const auto count = static_cast<std::size_t>(model_.hinges->elements.count());
    const double alpha = 1.0 / (model_.h * model_.h);
    Vec3 bend;
    double mobility = 0.0;
    const auto weight = [&](std::size_t k) {
        return static_cast<double>(
            model_.hinges->weights[k * count + static_cast<std::size_t>(hinge)]);
    };
    for (std::size_t k = 0; k < 4; ++k) {
        const auto i = static_cast<std::size_t>(corners[k]);
        bend = bend + weight(k) * x[i];
        mobility += inverse_mass_[i] * weight(k) * weight(k);
    }
    const double c = length(bend);
    if (c == 0.0) return;
    double& lambda = hinge_multipliers_[static_cast<std::size_t>(hinge)];
    const double change = (-c - alpha * lambda) / (mobility + alpha);
    lambda += change;
    for (std::size_t k = 0; k < 4; ++k) {
        const auto i = static_cast<std::size_t>(corners[k]);
        x[i] = x[i] + (inverse_mass_[i] * weight(k) * change / c) * bend;
    }
}

void ReferenceXpbd::collide(const Obstacle& obstacle, double time) {
    const Frame now = obstacle.frame_at(time + model_.h);
    const Frame before = obstacle.frame_at(time);
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (inverse_mass_[i] == 0.0) continue;
        const Surface surface = nearest(obstacle, now.to_local(x[i]));
        const double depth = obstacle.thickness - surface.distance;
        if (depth <= 0.0) continue;
        const Vec3 normal = now.axes * surface.normal;
        x[i] = x[i] + depth * normal;
        const Vec3 way = before.to_world(now.to_local(x[i])) - previous_[i];
        const Vec3 tangent = way - dot(way, normal) * normal;
        const double slid = length(tangent);
        if (slid == 0.0) continue;
        x[i] = x[i] - std::min(1.0, obstacle.friction.value_or(0.0) * depth / slid) * tangent;
    }
}

}  // namespace weft::test
