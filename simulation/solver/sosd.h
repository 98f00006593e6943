#pragma once

#include "simulation/solver/solver.h"

namespace weft {

/// Second-order stencil descent (Lan et al. 2023): sweeps (sweeps.h) in which the vertices of one
/// element, a stencil, solve one system together while all others stand still. Its gradient is that
/// of the whole E(x), with all elements that touch the stencil; so what the sweeps converge to is
/// the minimum of E. Its Hessian has the vertices' blocks of all elements, and between vertices
/// those of the stencil's own element, in a form that is positive semi-definite together with its
/// part of the vertices' blocks.
///
/// Stencils are elements of the families that offer it (has_stencils()): tetrahedra before
/// triangles before springs. In a sweep they are independent of each
/// other: a main block, one colour of elements, filled up with others between vertices that are
/// in none yet. A vertex that remains single solves its own 3x3 system. Successive sweeps have
/// different main blocks, so that all directions get their turn.
///
/// Where it differs from the paper: there the main block runs as Gauss-Seidel and all other
/// stencils beside it as Jacobi, and where they overlap the main block's displacement wins. Here
/// the main block leaves next to nothing to win, and what it leaves is Gauss-Seidel, too: the order
/// is the same everywhere, and no average slows it. The 6x6 systems of springs are solved by
/// elimination, the larger ones as in the paper by a few steps of PCG (kernels/sosd/). Stencils do
/// not cross from the vertices of a seam to those inside a strip. Obstacles push at the end of a
/// sweep instead of by a barrier.
std::unique_ptr<Solver> make_sosd_solver(Model& model);

}  // namespace weft
