#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseCore>

#include "simulation/reference/block_matrix.h"

namespace weft {

// Between our vectors and blocks and Eigen's.

Eigen::Vector3d to_eigen(const Vec3& v);
Eigen::Matrix3d to_eigen(const Mat3& m);
Mat3 to_mat3(const Eigen::Matrix3d& e);

/// The lower triangle of a matrix, number by number; rows without blocks have a 1 on the diagonal.
Eigen::SparseMatrix<double> lower_triangle(const BlockMatrix& a);

}  // namespace weft
