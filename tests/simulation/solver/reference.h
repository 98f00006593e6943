#pragma once

#include <Eigen/Dense>
#include <array>
#include <vector>

#include "simulation/model/model.h"

namespace weft::test {

/// XPBD once more: straightforward, in double precision, one element after the other in the order
/// that the layout defines. Shares the model's tables with the solver, and no arithmetic.
class ReferenceXpbd {
public:
    explicit ReferenceXpbd(const Model& model);

    /// One substep that ends at `time` + h.
    void substep(double time);

    std::vector<Vec3> x, v;  ///< new order [m], [m/s]

private:
    using Pair = std::array<double, 2>;

    void project_spring(int spring);
    void project_hinge(int hinge);
    void project_membrane(int triangle);
    void project_tetrahedron(int tetrahedron);
    void project_woven(int triangle);
    void project_pair(std::span<const int> corners, std::span<const Vec3> gradients_0,
                      std::span<const Vec3> gradients_1, Pair c, Pair compliance, Pair& lambda);
    void collide(const Obstacle& obstacle, double time);

    const Model& model_;
    std::vector<double> inverse_mass_, decay_;
    std::vector<double> spring_multipliers_, hinge_multipliers_;
    std::vector<Pair> membrane_multipliers_, tetrahedron_multipliers_;
    std::vector<Eigen::Vector3d> woven_multipliers_;
    std::vector<Vec3> previous_;
};

}  // namespace weft::test
