#include "tests/kernels/energies/differences.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace weft::test {

namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// The largest distance of a corner from the first, 1 where all are in one point: what a step is
/// measured by.
double size_of(const VectorXd& x) {
    double size = 0.0;
    for (int k = 3; k < x.size(); k += 3) {
        size = std::max(size, (x.segment<3>(k) - x.head<3>()).norm());
    }
    return size > 0.0 ? size : 1.0;
}

/// d f / d x_i for any f that can be added and scaled.
template <class Function>
auto derivative(const Function& f, const VectorXd& x, int i, double step) {
    const auto central = [&](double h) {
        VectorXd before = x;
        VectorXd behind = x;
        before(i) -= h;
        behind(i) += h;
        return MatrixXd((f(behind) - f(before)) / (2.0 * h));
    };
    const MatrixXd coarse = central(step);
    const MatrixXd middle = central(step / 2.0);
    const MatrixXd fine = central(step / 4.0);
    const MatrixXd low = (4.0 * middle - coarse) / 3.0;
    const MatrixXd high = (4.0 * fine - middle) / 3.0;
    return MatrixXd((16.0 * high - low) / 15.0);
}

constexpr double kStep = 1e-2;  // of the element's size

}  // namespace

VectorXd gradient_by_differences(const ElementEnergy& element, const VectorXd& x) {
    const auto energy = [&](const VectorXd& at) {
        return MatrixXd::Constant(1, 1, element.energy(at)).eval();
    };
    VectorXd gradient(x.size());
    for (int i = 0; i < x.size(); ++i) {
        gradient(i) = derivative(energy, x, i, kStep * size_of(x))(0, 0);
    }
    return gradient;
}

MatrixXd hessian_by_differences(const ElementEnergy& element, const VectorXd& x) {
    MatrixXd hessian(x.size(), x.size());
    for (int i = 0; i < x.size(); ++i) {
        hessian.col(i) = derivative(element.gradient, x, i, kStep * size_of(x));
    }
    return hessian;
}

double gradient_error(const ElementEnergy& element, const VectorXd& x) {
    return relative_difference(gradient_by_differences(element, x), element.gradient(x));
}

double hessian_error(const ElementEnergy& element, const VectorXd& x) {
    return relative_difference(hessian_by_differences(element, x), element.hessian(x));
}

double relative_difference(const MatrixXd& a, const MatrixXd& b) {
    const double size = std::max(a.norm(), b.norm());
    return size > 0.0 ? (a - b).norm() / size : 0.0;
}

MatrixXd positive_part(const MatrixXd& symmetric) {
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(symmetric);
    const MatrixXd& vectors = solver.eigenvectors();
    return vectors * solver.eigenvalues().cwiseMax(0.0).asDiagonal() * vectors.transpose();
}

double least_eigenvalue(const MatrixXd& symmetric) {
    const VectorXd values = Eigen::SelfAdjointEigenSolver<MatrixXd>(symmetric).eigenvalues();
    const double largest = values.cwiseAbs().maxCoeff();
    return largest > 0.0 ? values.minCoeff() / largest : 0.0;
}

double net_force(const ElementEnergy& element, const VectorXd& x) {
    const VectorXd gradient = element.gradient(x);
    Vector3d sum = Vector3d::Zero();
    double size = 0.0;
    for (int k = 0; k < x.size(); k += 3) {
        sum += gradient.segment<3>(k);
        size += gradient.segment<3>(k).norm();
    }
    return size > 0.0 ? sum.norm() / size : 0.0;
}

double net_moment(const ElementEnergy& element, const VectorXd& x) {
    const VectorXd gradient = element.gradient(x);
    Vector3d sum = Vector3d::Zero();
    double size = 0.0;
    for (int k = 0; k < x.size(); k += 3) {
        const Vector3d arm = x.segment<3>(k);
        sum += arm.cross(Vector3d(gradient.segment<3>(k)));
        size += arm.norm() * gradient.segment<3>(k).norm();
    }
    return size > 0.0 ? sum.norm() / size : 0.0;
}

}  // namespace weft::test
