#include "tests/simulation/solver/reference_ties.h"

#include <Eigen/Dense>
#include <cmath>

#include "simulation/solver/part_ties.h"

namespace weft::test {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

Vector3d in_eigen(Vec3 v) { return {v.x, v.y, v.z}; }

Matrix3d cross_matrix(const Vector3d& a) {
    Matrix3d m;
    m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
    return m;
}

/// Whose Rodrigues parameters are half the turn.
Matrix3d rotation_of(const Vector3d& turn) {
    if (turn.norm() == 0.0) return Matrix3d::Identity();
    const double angle = 2.0 * std::atan(0.5 * turn.norm());
    return Eigen::AngleAxisd(angle, turn.normalized()).toRotationMatrix();
}

class Part {
public:
    Part(const Model& model, const TieTable& table, int part, std::vector<Vec3>& x,
         const std::vector<Vec3>& target)
        : model_(model), table_(table), part_(part), x_(x), target_(target) {
        for (const int v : vertices()) mass_ += model.masses[index(v)];
        for (const int v : vertices()) centre_ += share(v) * in_eigen(x[index(v)]);
        const Matrix3d spread = spread_of_mass();
        inertia_ = 1.00002 * spread.trace() * Matrix3d::Identity() - spread;
    }

    void round() {
        Matrix6 form = Matrix6::Identity();
        form.bottomRightCorner<3, 3>() = inertia_;
        Vector6 force = inertial_force();
        for (const PartTie& tie : table_.ties) {
            if (tie.part == part_) add(tie, form, force);
        }
        motion_ += form.ldlt().solve(force);
    }

    void move() {
        for (const int v : vertices()) {
            const Vector3d to = place(v);
            x_[index(v)] = {to.x(), to.y(), to.z()};
        }
    }

private:
    const std::vector<int>& vertices() const { return table_.vertices[index(part_)]; }
    double share(int v) const { return model_.masses[index(v)] / mass_; }
    Vector3d lever(int v) const {
        return rotation_of(motion_.tail<3>()) * (in_eigen(x_[index(v)]) - centre_);
    }
    Vector3d place(int v) const { return centre_ + motion_.head<3>() + lever(v); }

    Matrix3d spread_of_mass() const {
        Matrix3d sum = Matrix3d::Zero();
        for (const int v : vertices()) {
            const Vector3d r = in_eigen(x_[index(v)]) - centre_;
            sum += share(v) * r * r.transpose();
        }
        return sum;
    }

    Vector6 inertial_force() const {
        Vector6 force = Vector6::Zero();
        for (const int v : vertices()) {
            const Vector3d target = in_eigen(target_[index(v)]);
            force.head<3>() += share(v) * (target - place(v));
            force.tail<3>() += share(v) * lever(v).cross(target - centre_ - lever(v));
        }
        return force;
    }

    void add(const PartTie& tie, Matrix6& form, Vector6& force) const {
        const double stiffness = tie.tie.stiffness * model_.h * model_.h / mass_;
        const Vector3d gap = in_eigen(x_[index(tie.other)]) - place(tie.vertex);
        const Vector3d pull = stiffness * (1.0 - tie.tie.rest / gap.norm()) * gap;
        const Matrix3d arm = cross_matrix(lever(tie.vertex));
        force.head<3>() += pull;
        force.tail<3>() += arm * pull;
        Eigen::Matrix<double, 3, 6> way;
        way << Matrix3d::Identity(), -arm;
        form += stiffness * way.transpose() * way;
    }

    const Model& model_;
    const TieTable& table_;
    int part_;
    std::vector<Vec3>& x_;
    const std::vector<Vec3>& target_;
    double mass_ = 0.0;
    Vector3d centre_ = Vector3d::Zero();
    Matrix3d inertia_;
    Vector6 motion_ = Vector6::Zero();
};

}  // namespace

void lead_parts(const Model& model, std::vector<Vec3>& x, const std::vector<Vec3>& target) {
    const TieTable table = find_part_ties(model);
    for (std::size_t part = 0; part < table.vertices.size(); ++part) {
        Part led(model, table, static_cast<int>(part), x, target);
        led.round();
        led.round();
        led.move();
    }
}

}  // namespace weft::test
