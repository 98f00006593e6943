#include "tests/simulation/solver/reference.h"

#include <algorithm>

#include "simulation/families/convert.h"
#include "simulation/families/hinges/hinges.h"
#include "simulation/families/membranes/membranes.h"
#include "simulation/families/springs/springs.h"
#include "simulation/families/tetrahedra/tetrahedra.h"
#include "simulation/families/woven/woven.h"

namespace weft::test {

namespace {

/// Elements of a phase in their order.
template <class Project>
void sweep(const Elements& elements, Phase phase, Project project) {
    const Segments& s = elements.segments(phase);
    for (int item = s.item(0); item < s.item(s.strip_count); ++item) project(item);
}

Vec3 shape_gradient(const Tetrahedra& all, int tetrahedron, int corner) {
    const auto [x, y, z] = all.shape_gradient(tetrahedron, corner);
    return {x, y, z};
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
        return kind ? static_cast<std::size_t>(kind->elements().count()) : 0;
    };
    spring_multipliers_.assign(count(model_.find<Springs>()), 0.0);
    hinge_multipliers_.assign(count(model_.find<Hinges>()), 0.0);
    membrane_multipliers_.assign(count(model_.find<Membranes>()), {});
    woven_multipliers_.assign(count(model_.find<WovenCloth>()), Eigen::Vector3d::Zero());
    tetrahedron_multipliers_.assign(count(model_.find<Tetrahedra>()), {});
    for (int iteration = 0; iteration < model_.scene.solver.iterations; ++iteration) {
        for (const Phase phase : {kSeamPhase, kInnerPhase}) {
            if (model_.find<Springs>()) {
                sweep(model_.find<Springs>()->elements(), phase,
                      [&](int spring) { project_spring(spring); });
            }
            if (model_.find<Membranes>()) {
                sweep(model_.find<Membranes>()->elements(), phase,
                      [&](int m) { project_membrane(m); });
            }
            if (model_.find<Tetrahedra>()) {
                sweep(model_.find<Tetrahedra>()->elements(), phase,
                      [&](int t) { project_tetrahedron(t); });
            }
            if (model_.find<Hinges>()) {
                sweep(model_.find<Hinges>()->elements(), phase,
                      [&](int hinge) { project_hinge(hinge); });
            }
            if (model_.find<WovenCloth>()) {
                sweep(model_.find<WovenCloth>()->elements(), phase,
                      [&](int triangle) { project_woven(triangle); });
            }
        }
        for (const Obstacle& obstacle : model_.scene.obstacles) collide(obstacle, time);
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
        v[i] = inverse_mass_[i] > 0.0 ? (decay_[i] / h) * (x[i] - previous_[i]) : Vec3{};
    }
}

void ReferenceXpbd::project_spring(int spring) {
    const auto ends = model_.find<Springs>()->elements().vertices_of(spring);
    const auto a = static_cast<std::size_t>(ends[0]);
    const auto b = static_cast<std::size_t>(ends[1]);
    const double alpha = 1.0 / (model_.find<Springs>()->stiffness(spring) * model_.h * model_.h);
    const Vec3 along = x[a] - x[b];
    const double c = length(along) - model_.find<Springs>()->rest_length(spring);
    double& lambda = spring_multipliers_[static_cast<std::size_t>(spring)];
    const double change = (-c - alpha * lambda) / (inverse_mass_[a] + inverse_mass_[b] + alpha);
    lambda += change;
    const Vec3 direction = normalized(along);
    x[a] = x[a] + (inverse_mass_[a] * change) * direction;
    x[b] = x[b] - (inverse_mass_[b] * change) * direction;
}

void ReferenceXpbd::project_hinge(int hinge) {
    const auto corners = model_.find<Hinges>()->elements().vertices_of(hinge);
    const auto count = static_cast<std::size_t>(model_.find<Hinges>()->elements().count());
    const double alpha = 1.0 / (model_.h * model_.h);
    Vec3 bend;
    double mobility = 0.0;
    const auto weight = [&](std::size_t k) {
        return static_cast<double>(
            model_.find<Hinges>()->weights[k * count + static_cast<std::size_t>(hinge)]);
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

/// Both constraints at once: (grad C M^-1 grad C^T + A) dlambda = -C - A lambda, by Cramer's rule.
void ReferenceXpbd::project_pair(std::span<const int> corners, std::span<const Vec3> gradients_0,
                                 std::span<const Vec3> gradients_1, Pair c, Pair compliance,
                                 Pair& lambda) {
    double g00 = compliance[0];
    double g11 = compliance[1];
    double g01 = 0.0;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const double w = inverse_mass_[static_cast<std::size_t>(corners[k])];
        g00 += w * dot(gradients_0[k], gradients_0[k]);
        g01 += w * dot(gradients_0[k], gradients_1[k]);
        g11 += w * dot(gradients_1[k], gradients_1[k]);
    }
    const double r0 = -c[0] - compliance[0] * lambda[0];
    const double r1 = -c[1] - compliance[1] * lambda[1];
    const double determinant = g00 * g11 - g01 * g01;
    const double change0 = (r0 * g11 - r1 * g01) / determinant;
    const double change1 = (r1 * g00 - r0 * g01) / determinant;
    lambda[0] += change0;
    lambda[1] += change1;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const auto i = static_cast<std::size_t>(corners[k]);
        x[i] = x[i] + inverse_mass_[i] * (change0 * gradients_0[k] + change1 * gradients_1[k]);
    }
}

/// Deformation by the images of the axes of the plane at rest. The energy is mu/2 S^2 + lambda/2 (J
/// - 1)^2 with S^2 = |F|^2 - 2 J.
void ReferenceXpbd::project_membrane(int triangle) {
    const Membranes& all = *model_.find<Membranes>();
    const auto corners = all.elements().vertices_of(triangle);
    Vec3 f, g;
    for (int k = 0; k < 3; ++k) {
        const auto [along_u, along_v] = all.shape_gradient(triangle, k);
        const Vec3 corner = x[static_cast<std::size_t>(corners[static_cast<std::size_t>(k)])];
        f = f + along_u * corner;
        g = g + along_v * corner;
    }
    const double area = length(cross(f, g));
    const double strain = std::sqrt(std::max(1e-16, dot(f, f) + dot(g, g) - 2.0 * area));
    const Vec3 normal = (1.0 / area) * cross(f, g);
    std::array<Vec3, 3> of_area, of_shape;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto [along_u, along_v] = all.shape_gradient(triangle, static_cast<int>(k));
        of_area[k] = along_u * cross(g, normal) + along_v * cross(normal, f);
        of_shape[k] = (1.0 / strain) * (along_u * f + along_v * g - of_area[k]);
    }
    const double h2 = model_.h * model_.h;
    project_pair(corners, of_area, of_shape, {area - 1.0, strain},
                 {1.0 / (all.lambda(triangle) * h2), 1.0 / (all.mu(triangle) * h2)},
                 membrane_multipliers_[static_cast<std::size_t>(triangle)]);
}

/// Deformation by the images of the axes at rest. The energy is mu/2 S^2 + (lambda - mu)/2 (J -
/// 1)^2 with S^2 = |F|^2 + J^2 - 4 J.
void ReferenceXpbd::project_tetrahedron(int tetrahedron) {
    const Tetrahedra& all = *model_.find<Tetrahedra>();
    const auto corners = all.elements().vertices_of(tetrahedron);
    Vec3 f, g, h;
    for (int k = 0; k < 4; ++k) {
        const Vec3 b = shape_gradient(all, tetrahedron, k);
        const Vec3 corner = x[static_cast<std::size_t>(corners[static_cast<std::size_t>(k)])];
        f = f + b.x * corner;
        g = g + b.y * corner;
        h = h + b.z * corner;
    }
    const double J = dot(f, cross(g, h));
    const double strain =
        std::sqrt(std::max(1e-16, dot(f, f) + dot(g, g) + dot(h, h) + J * J - 4.0 * J));
    std::array<Vec3, 4> of_volume, of_shape;
    for (std::size_t k = 0; k < 4; ++k) {
        const Vec3 b = shape_gradient(all, tetrahedron, static_cast<int>(k));
        of_volume[k] = b.x * cross(g, h) + b.y * cross(h, f) + b.z * cross(f, g);
        of_shape[k] = (1.0 / strain) * (b.x * f + b.y * g + b.z * h + (J - 2.0) * of_volume[k]);
    }
    const double h2 = model_.h * model_.h;
    const double mu = all.mu(tetrahedron);
    project_pair(corners, of_volume, of_shape, {J - 1.0, strain},
                 {1.0 / ((all.lambda(tetrahedron) - mu) * h2), 1.0 / (mu * h2)},
                 tetrahedron_multipliers_[static_cast<std::size_t>(tetrahedron)]);
}

/// The strains of both threads, and the cosine of the angle between them times their stretches.
void ReferenceXpbd::project_woven(int triangle) {
    const WovenCloth& all = *model_.find<WovenCloth>();
    const auto corners = all.elements().vertices_of(triangle);
    Vec3 warp, weft;
    for (int k = 0; k < 3; ++k) {
        const auto [along_u, along_v] = all.shape_gradient(triangle, k);
        const Vec3 corner = x[static_cast<std::size_t>(corners[static_cast<std::size_t>(k)])];
        warp = warp + along_u * corner;
        weft = weft + along_v * corner;
    }
    std::array<std::array<Vec3, 3>, 3> gradients;  // [constraint][corner]
    Eigen::Vector3d compliance;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto [of_warp, of_weft] = all.shape_gradient(triangle, static_cast<int>(k));
        gradients[0][k] = of_warp * normalized(warp);
        gradients[1][k] = of_weft * normalized(weft);
        gradients[2][k] = of_warp * weft + of_weft * warp;
        compliance[static_cast<Eigen::Index>(k)] =
            1.0 / (all.stiffness(triangle, static_cast<int>(k)) * model_.h * model_.h);
    }
    Eigen::Matrix3d system = compliance.asDiagonal();
    for (Eigen::Index a = 0; a < 3; ++a) {
        for (Eigen::Index b = 0; b < 3; ++b) {
            for (std::size_t k = 0; k < 3; ++k) {
                system(a, b) += inverse_mass_[static_cast<std::size_t>(corners[k])] *
                                dot(gradients[static_cast<std::size_t>(a)][k],
                                    gradients[static_cast<std::size_t>(b)][k]);
            }
        }
    }
    Eigen::Vector3d& lambda = woven_multipliers_[static_cast<std::size_t>(triangle)];
    const Eigen::Vector3d c(length(warp) - 1.0, length(weft) - 1.0, dot(warp, weft));
    const Eigen::Vector3d change =
        -system.fullPivLu().solve(c + Eigen::Vector3d(compliance.cwiseProduct(lambda)));
    lambda += change;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto i = static_cast<std::size_t>(corners[k]);
        x[i] =
            x[i] + inverse_mass_[i] * (change[0] * gradients[0][k] + change[1] * gradients[1][k] +
                                       change[2] * gradients[2][k]);
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
