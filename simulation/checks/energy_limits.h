#pragma once

#include <string>

#include "simulation/model/model.h"

/// What is excused before energy counts as from nowhere: of a whole scene (energy_account.h) and of
/// single bodies (body_accounts.h).
namespace weft {

/// Beyond what sweeps of few iterations do in scenes that look as they should.
inline constexpr double kMostMotion = 2.0;
/// And what no such sweep does.
inline constexpr double kExplodingMotion = 10.0;
inline constexpr double kSmallFall = 0.01;  ///< of its size
/// What is higher than all energy there was could lift it: likewise.
inline constexpr double kSmallLift = 0.0025;

/// What it takes to lift vertices [begin, end) by the diagonal of the box around them [J]; gravity
/// is that of time 0.
double lift_by_size(const Model& model, int begin, int end);

/// What the elements have more of where every coordinate is off by its own last bits [J], and what
/// motion that makes. Each coordinate for itself: a thin plate has large ones and small ones, and
/// only along the large ones is there much to lose.
double energy_of_rounding(const Model& model);

/// How much energy there was to be had, or how much too little for how high all is, in words.
std::string there_was(double had, double lifted);

}  // namespace weft
