#pragma once

#include <functional>
#include <string>

#include "simulation/reference/incremental_potential.h"

namespace weft {

/// How sure it is that a minimum is one; both scale-free.
struct Certificate {
    /// |dE/dx| over the sizes of the forces that cancel in it; 1e-16 is double precision's
    /// rounding.
    double relative_gradient = 0.0;
    /// 1/2 g^T H^-1 g / (E0 - E*), the Newton decrement: how far below E* the quadratic model there
    /// has its minimum, as a relative error.
    double relative_gap = 0.0;
    int iterations = 0;  ///< of Newton's method
};

/// The minimiser of an incremental potential.
struct Minimum {
    std::vector<Vec3> x;        ///< [vertices] new order
    double energy = 0.0;        ///< E* [J]
    double start_energy = 0.0;  ///< E0 [J], at x~
    Certificate certificate;
};

/// A relative gap that counts as solved: far below what any solver in single precision reaches.
inline constexpr double kSolvedGap = 1e-9;

/// Minimises by Newton's method from `start`, to the last digits: with the exact Hessian where it
/// is positive definite, else with a part of the elements' negative curvature projected away (all
/// of it: Teran et al. 2005), and a backtracking line search. Deterministic. Check the certificate:
/// `relative_gap` beyond kSolvedGap is no minimum. progress: told of each iteration; may be empty
/// enough: a relative gap to stop at; 0: goes on to the last digits of the positions
Minimum minimise(IncrementalPotential& potential, std::vector<Vec3> start,
                 const std::function<void(const Certificate&)>& progress = {}, double enough = 0.0);

}  // namespace weft
