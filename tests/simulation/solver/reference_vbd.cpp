#include "tests/simulation/solver/reference_vbd.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "simulation/families/convert.h"
#include "simulation/families/hinges/hinges.h"
#include "simulation/families/membranes/membranes.h"
#include "simulation/families/springs/springs.h"
#include "simulation/families/tetrahedra/tetrahedra.h"
#include "tests/simulation/solver/reference_ties.h"

namespace weft::test {

namespace {

enum Kind { kSprings, kHinges, kMembranes, kTetrahedra };

std::size_t index(int i) { return static_cast<std::size_t>(i); }

int corner_of(std::span<const int> corners, int vertex) {
    return static_cast<int>(std::ranges::find(corners, vertex) - corners.begin());
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& u) {
    Eigen::Matrix3d m;
    m << 0.0, -u.z(), u.y(), u.z(), 0.0, -u.x(), -u.y(), u.x(), 0.0;
    return m;
}

}  // namespace

void ReferenceVbd::System::add_dyad(double factor, Vec3 d) {
    hessian[0] = hessian[0] + (factor * d.x) * d;
    hessian[1] = hessian[1] + (factor * d.y) * d;
    hessian[2] = hessian[2] + (factor * d.z) * d;
}

void ReferenceVbd::System::add_diagonal(double value) {
    hessian[0].x += value;
    hessian[1].y += value;
    hessian[2].z += value;
}

/// By Cramer's rule.
Vec3 ReferenceVbd::System::solve(Vec3 force) const {
    const auto& [a, b, c] = hessian;
    const double determinant = dot(a, cross(b, c));
    const Vec3 along = force.x * cross(b, c) + force.y * cross(c, a) + force.z * cross(a, b);
    return (1.0 / determinant) * along;
}

ReferenceVbd::ReferenceVbd(const Model& model)
    : model_(model), layout_(make_vertex_layout(model.stencils(), model.strips)) {
    const std::size_t count = model.masses.size();
    for (std::size_t i = 0; i < count; ++i) {
        const float4& position = (*model.positions)[i];
        x.push_back(to_vec3(position));
        v.push_back(to_vec3((*model.velocities)[i]));
        mass_.push_back(position.w > 0.0f ? model.masses[i] : 0.0);
        decay_.push_back(static_cast<double>((*model.velocities)[i].w));
    }
    deviation_.resize(count);
    target_.resize(count);
    pushed_.resize(count);
    const auto add = [&](Kind kind, const ElementFamily* family) {
        touching_[kind].resize(count);
        if (family == nullptr) return;
        for (int e = 0; e < family->count(); ++e) {
            for (const int vertex : family->corners(e)) {
                touching_[kind][index(vertex)].push_back(e);
            }
        }
    };
    add(kSprings, model.find<Springs>());
    add(kHinges, model.find<Hinges>());
    add(kMembranes, model.find<Membranes>());
    add(kTetrahedra, model.find<Tetrahedra>());
}

void ReferenceVbd::substep(double time) {
    const std::vector<Vec3> previous = x;
    begin(time);
    lead_parts(model_, x, target_);
    for (int iteration = 0; iteration < model_.scene.solver.iterations; ++iteration) {
        for (const int vertex : layout_.vertices) move(vertex);
        collide();
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
        deviation_[i] = x[i] - target_[i];
        v[i] = decay_[i] * ((1.0 / model_.h) * (x[i] - previous[i]));
    }
    move_body();
    push_out();
}

/// Where all would fall freely, and, to start from, less what was held up of the last fall.
void ReferenceVbd::begin(double time) {
    const double h = model_.h;
    const Vec3 gravity = model_.scene.gravity_at(time + 0.5 * h);
    for (std::size_t i = 0; i < x.size(); ++i) {
        target_[i] = x[i];
        if (mass_[i] == 0.0) continue;
        target_[i] = x[i] + h * (v[i] + h * gravity);
        const double fall = dot(deviation_[i], gravity) / dot(gravity, gravity) / (h * h);
        const double held_up = std::clamp(fall, -1.0, 0.0);
        x[i] = target_[i];
        if (held_up < -0.125) x[i] = x[i] + (held_up * h * h) * gravity;
    }
    start_ = target_;
    pushed_.assign(x.size(), false);
    collide();
}

/// Of elements alone.
ReferenceVbd::System ReferenceVbd::system_of(int vertex) const {
    const std::size_t i = index(vertex);
    System system;
    for (const int e : touching_[kSprings][i]) add_spring(system, e, vertex);
    for (const int e : touching_[kHinges][i]) add_hinge(system, e, vertex);
    for (const int e : touching_[kMembranes][i]) add_membrane(system, e, vertex);
    for (const int e : touching_[kTetrahedra][i]) add_tetrahedron(system, e, vertex);
    return system;
}

void ReferenceVbd::move(int vertex) {
    const std::size_t i = index(vertex);
    if (mass_[i] == 0.0) return;
    const double inertia = mass_[i] / (model_.h * model_.h);
    System system = system_of(vertex);
    system.gradient = system.gradient + inertia * (x[i] - start_[i]);
    system.add_diagonal(inertia);
    // What has been pushed is borne by what keeps it out of the plane; all else by its pushes.
    if (pushed_[i]) target_[i] = start_[i] + (1.0 / inertia) * borne(system, i);
    const Vec3 pushes = inertia * (target_[i] - start_[i]);
    x[i] = x[i] + system.solve(pushes - system.gradient);
}

Vec3 ReferenceVbd::borne(const System& system, std::size_t vertex) const {
    const Obstacle& plane = model_.scene.obstacles.front();
    const Frame frame = plane.frame_at(0.0);
    const Vec3 normal = frame.axes * Vec3{0.0, 1.0, 0.0};
    const double gap = frame.to_local(x[vertex]).y - plane.thickness;
    const double inwards = -gap - dot(normal, system.solve(-system.gradient));
    return (std::max(inwards, 0.0) / dot(normal, system.solve(normal))) * normal;
}

/// Shifts and turns all that is free about the vertex that is held, to where the forces of inertia,
/// the pull of that vertex and its stiffness against the shift are in balance, and the torques of
/// inertia, of which it has none. Of a body that the plane pushes, a part of it.
void ReferenceVbd::move_body() {
    const auto held = static_cast<std::size_t>(std::ranges::find(mass_, 0.0) - mass_.begin());
    const double h2 = model_.h * model_.h;
    const auto to_eigen = [](Vec3 u) { return Eigen::Vector3d(u.x, u.y, u.z); };
    const System system = system_of(static_cast<int>(held));
    const Eigen::Vector3d pull = to_eigen(system.gradient);
    Eigen::Matrix3d stiffness;
    for (int k = 0; k < 3; ++k) stiffness.row(k) = to_eigen(system.hessian[index(k)]);
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    double mass = 0.0, pushed = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        mass += mass_[i];
        if (length(target_[i] - start_[i]) > 0.0) pushed += mass_[i];
    }
    for (int round = 0; round < 10; ++round) {
        Eigen::Matrix<double, 6, 6> form = Eigen::Matrix<double, 6, 6>::Zero();
        Eigen::Matrix<double, 6, 1> missing = Eigen::Matrix<double, 6, 1>::Zero();
        for (std::size_t i = 0; i < x.size(); ++i) {
            const Eigen::Vector3d r = to_eigen(x[i] - x[held]), turned = turn * r;
            const Eigen::Vector3d lag = to_eigen(target_[i] - x[i]) + r - shift - turned;
            Eigen::Matrix<double, 3, 6> arm;
            arm << Eigen::Matrix3d::Identity(), -cross_matrix(turned);
            form += mass_[i] / h2 * arm.transpose() * arm;
            missing += mass_[i] / h2 * arm.transpose() * lag;
        }
        form.topLeftCorner<3, 3>() += stiffness;
        missing.head<3>() += pull - stiffness * shift;
        const Eigen::Matrix<double, 6, 1> step = form.ldlt().solve(missing);
        shift += step.head<3>();
        const double angle = step.tail<3>().norm();
        if (angle > 0.0) turn = Eigen::AngleAxisd(angle, step.tail<3>() / angle) * turn;
    }
    const double part = 1.0 / (1.0 + 50.0 * pushed / mass);
    const Eigen::AngleAxisd whole(turn);
    const Eigen::Matrix3d led =
        Eigen::AngleAxisd(2.0 * std::atan(part * std::tan(0.5 * whole.angle())), whole.axis())
            .toRotationMatrix();
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (mass_[i] == 0.0) continue;
        const Eigen::Vector3d r = to_eigen(x[i] - x[held]);
        const Eigen::Vector3d way = part * shift + led * r - r;
        shift_vertex(i, {way.x(), way.y(), way.z()});
        deviation_[i] = deviation_[i] + Vec3{way.x(), way.y(), way.z()};
    }
}

void ReferenceVbd::shift_vertex(std::size_t i, Vec3 way) {
    x[i] = x[i] + way;
    v[i] = v[i] + (decay_[i] / model_.h) * way;
}

/// Out of the plane, once more.
void ReferenceVbd::push_out() {
    for (const Obstacle& obstacle : model_.scene.obstacles) {
        const Frame frame = obstacle.frame_at(0.0);
        for (std::size_t i = 0; i < x.size(); ++i) {
            const double depth = obstacle.thickness - frame.to_local(x[i]).y;
            if (mass_[i] == 0.0 || depth <= 0.0) continue;
            shift_vertex(i, depth * (frame.axes * Vec3{0.0, 1.0, 0.0}));
        }
    }
}

/// E = k/2 (l - rest)^2; a compressed spring's stiffness across itself is left out.
void ReferenceVbd::add_spring(System& system, int spring, int vertex) const {
    const Springs& all = *model_.find<Springs>();
    const auto ends = all.corners(spring);
    const int other = ends[0] == vertex ? ends[1] : ends[0];
    const Vec3 along = x[index(vertex)] - x[index(other)];
    const double l = length(along);
    if (l == 0.0) return;
    const double rest = all.rest_length(spring);
    const double k = all.stiffness(spring);
    const double across = std::max(0.0, k * (1.0 - rest / l));
    system.gradient = system.gradient + (k * (l - rest) / l) * along;
    system.add_dyad((k - across) / (l * l), along);
    system.add_diagonal(across);
}

/// E = 1/2 |sum q_j x_j|^2
void ReferenceVbd::add_hinge(System& system, int hinge, int vertex) const {
    const Hinges& all = *model_.find<Hinges>();
    const auto corners = all.corners(hinge);
    Vec3 bend;
    for (int k = 0; k < 4; ++k) {
        bend = bend + all.weight(hinge, k) * x[index(corners[index(k)])];
    }
    const double own = all.weight(hinge, corner_of(corners, vertex));
    system.gradient = system.gradient + own * bend;
    system.add_diagonal(own * own);
}

/// E = mu/2 (|F|^2 - 2) - mu (J - 1) + lambda/2 (J - 1)^2, F = [f g], J = |f x g|; what would be
/// negative along the normal counts as 0.
void ReferenceVbd::add_membrane(System& system, int triangle, int vertex) const {
    const Membranes& all = *model_.find<Membranes>();
    const auto corners = all.corners(triangle);
    Vec3 f, g;
    for (int k = 0; k < 3; ++k) {
        const auto [along_u, along_v] = all.shape_gradient(triangle, k);
        f = f + along_u * x[index(corners[index(k)])];
        g = g + along_v * x[index(corners[index(k)])];
    }
    const double J = length(cross(f, g));
    const Vec3 normal = (1.0 / J) * cross(f, g);
    const auto [u, w] = all.shape_gradient(triangle, corner_of(corners, vertex));
    const Vec3 of_area = u * cross(g, normal) + w * cross(normal, f);
    const double mu = all.mu(triangle);
    const double pressure = all.lambda(triangle) * (J - 1.0) - mu;
    const double in_plane = mu * (u * u + w * w);
    system.gradient = system.gradient + mu * (u * f + w * g) + pressure * of_area;
    system.add_diagonal(in_plane);
    system.add_dyad(all.lambda(triangle), of_area);
    system.add_dyad(std::max(pressure * dot(of_area, of_area) / J, -in_plane), normal);
}

/// E = mu/2 (|F|^2 - 3) - mu (J - 1) + lambda/2 (J - 1)^2, J = det F
void ReferenceVbd::add_tetrahedron(System& system, int tetrahedron, int vertex) const {
    const Tetrahedra& all = *model_.find<Tetrahedra>();
    const auto corners = all.corners(tetrahedron);
    Vec3 f, g, h;
    for (int k = 0; k < 4; ++k) {
        const auto b = all.shape_gradient(tetrahedron, k);
        const Vec3 corner = x[index(corners[index(k)])];
        f = f + b[0] * corner;
        g = g + b[1] * corner;
        h = h + b[2] * corner;
    }
    const double J = dot(f, cross(g, h));
    const auto own = all.shape_gradient(tetrahedron, corner_of(corners, vertex));
    const Vec3 b{own[0], own[1], own[2]};
    const Vec3 of_volume = b.x * cross(g, h) + b.y * cross(h, f) + b.z * cross(f, g);
    const double mu = all.mu(tetrahedron);
    const double pressure = all.lambda(tetrahedron) * (J - 1.0) - mu;
    system.gradient = system.gradient + mu * (b.x * f + b.y * g + b.z * h) + pressure * of_volume;
    system.add_diagonal(mu * dot(b, b));
    system.add_dyad(all.lambda(tetrahedron), of_volume);
}

/// A push moves the inertia's target along, so that it counts once.
void ReferenceVbd::collide() {
    for (const Obstacle& obstacle : model_.scene.obstacles) {
        const Frame frame = obstacle.frame_at(0.0);
        const Vec3 normal = frame.axes * Vec3{0.0, 1.0, 0.0};
        for (std::size_t i = 0; i < x.size(); ++i) {
            const double depth = obstacle.thickness - frame.to_local(x[i]).y;
            if (mass_[i] == 0.0 || depth <= 0.0) continue;
            pushed_[i] = true;
            x[i] = x[i] + depth * normal;
            target_[i] = target_[i] + depth * normal;
        }
    }
}

}  // namespace weft::test
