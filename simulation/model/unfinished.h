#pragma once

#include <span>

#include "simulation/model/load_paths.h"

namespace weft {

/// The strain (RMS) that unfinished sweeps leave, at least about: n sweeps are no stiffer than m n
/// / (2 h^2) per edge, and the weight of all levels hangs on the last one: 2 g h^2 levels burden /
/// (n edge). Measured: 1 to 2.5 times this (docs/scenes.md).
/// h  the substep [s]; gravity  [m/s^2]
double unfinished_strain(const LoadPath& path, double h, int iterations, double gravity);

/// How much farther than it should what bears by bending sags, in parts of how far it should, at
/// most: a sweep moves each vertex against its own firmness, and so takes back a part of 2 / (h^2
/// firmness) of a smooth sag; what is left of it, gravity adds to in every substep. With x sweeps
/// of that: 1 / (exp(x) - 1). Sweeps do 1.25 times that or more (docs/measurements.md).
double unfinished_sag(const LoadPath& path, double h, int iterations);

/// How far cloth sags across its span, in parts of that: a parabola of x is 8/3 x^2 longer, and its
/// tension, the load times the span over 8 x, makes it as much longer, but for its slack.
/// stiffness  what of its own it shows
double sag_of_span(const LoadPath& path, double gravity, double stiffness = 1.0);

/// What xpbd's sweeps let cloth show of its stiffness across its span: multipliers begin anew in
/// each substep, and each sweep brings them 1 / (1 + r) of the way to where they belong, with r = 2
/// (wave h / stride)^2; as they see each other's corrections, 1.5 to 1.9 times as often, as
/// measured.
double finished_stiffness(const LoadPath& path, double h, int iterations);

/// The number of substeps, however large, by which cloth sags across its span no more than 5 % or
/// 2e-3 of the span farther than it should, by xpbd. 0: it has no span.
double substeps_for_span(const LoadPath& path, double dt, int iterations, double gravity);

/// The number of substeps, however large, that keeps the strain at half a per cent; of solids,
/// whose bending adds to it, at a fifth of that, and less the more slender they are.
/// dt  the frame [s]
double substeps_for_strain(const LoadPath& path, double dt, int iterations, double gravity);

/// The number of substeps, however large, that lets it sag too far by no more than 15 % or 1e-4 of
/// its length (cloth 5e-4, solids that are not slender up to 1e-3), and lets cloth that hangs down
/// behind its bend come nearer by no more than 2 % of its length. 0: it bears by no bending.
double substeps_for_bending(const LoadPath& path, double dt, int iterations, double gravity);

/// The largest number of substeps in which single precision keeps what gravity does, 1 at least.
/// reach  the largest coordinate [m]
double substeps_of_rounding(double reach, double dt, double gravity);

}  // namespace weft
