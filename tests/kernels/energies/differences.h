#pragma once

#include <Eigen/Dense>
#include <functional>
#include <random>

#include "kernels/matrix.h"
#include "kernels/vector.h"

// Energies of elements against finite differences. The element functions are those of the kernels,
// compiled with real = double.

namespace weft::test {

/// One element of fixed rest shape and stiffness, as functions of its corners' coordinates.
/// x: [3 * corners], corner by corner [m]
struct ElementEnergy {
    std::function<double(const Eigen::VectorXd& x)> energy;
    std::function<Eigen::VectorXd(const Eigen::VectorXd& x)> gradient;
    /// All blocks, assembled as a solver does; projected where the element function says so.
    std::function<Eigen::MatrixXd(const Eigen::VectorXd& x)> hessian;
};

/// Derivatives by central differences, extrapolated to sixth order (Richardson): right to about
/// 1e-10 for energies that are smooth over a hundredth of the element's size.
Eigen::VectorXd gradient_by_differences(const ElementEnergy& element, const Eigen::VectorXd& x);
/// Of the gradient, so it is the exact one, not the projected one.
Eigen::MatrixXd hessian_by_differences(const ElementEnergy& element, const Eigen::VectorXd& x);

/// |gradient - differences| / |gradient|, and the same for the Hessian (Frobenius norms).
double gradient_error(const ElementEnergy& element, const Eigen::VectorXd& x);
double hessian_error(const ElementEnergy& element, const Eigen::VectorXd& x);

double relative_difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// The nearest positive semi-definite matrix: negative eigenvalues become 0.
Eigen::MatrixXd positive_part(const Eigen::MatrixXd& symmetric);
/// The smallest eigenvalue over the largest absolute one; 0 for the zero matrix.
double least_eigenvalue(const Eigen::MatrixXd& symmetric);

/// The sum of an internal energy's forces, over the sum of their sizes; and likewise the sum of
/// their moments about the origin. Both are 0 to rounding where the energy does not change under
/// translations and rotations.
double net_force(const ElementEnergy& element, const Eigen::VectorXd& x);
double net_moment(const ElementEnergy& element, const Eigen::VectorXd& x);

/// Corner `k` of x, and back.
inline kernels::real3 corner(const Eigen::VectorXd& x, int k) {
    return kernels::make3(x(3 * k), x(3 * k + 1), x(3 * k + 2));
}
inline Eigen::Vector3d to_eigen(kernels::real3 v) { return {v.x, v.y, v.z}; }
inline Eigen::Matrix3d to_eigen(kernels::mat3 a) {
    Eigen::Matrix3d m;
    m << to_eigen(a.x), to_eigen(a.y), to_eigen(a.z);
    return m;
}
inline Eigen::Matrix3d to_eigen(kernels::sym3 a) {
    return (Eigen::Matrix3d() << a.xx, a.xy, a.xz, a.xy, a.yy, a.yz, a.xz, a.yz, a.zz).finished();
}

/// Coordinates between -size and size, the same with every standard library.
inline Eigen::VectorXd random_corners(std::mt19937& engine, int corners, double size = 1.0) {
    Eigen::VectorXd x(3 * corners);
    for (double& value : x) {
        value = size * (2.0 * static_cast<double>(engine()) / 4294967295.0 - 1.0);
    }
    return x;
}

}  // namespace weft::test
