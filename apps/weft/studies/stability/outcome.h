#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/weft/run/run_options.h"
#include "apps/weft/studies/stability/cases.h"

namespace weft::stability {

/// How one case came out with one solver.
struct Outcome {
    std::string solver;
    Verdict verdict = Verdict::kStable;
    /// Whether the run said by itself that something is wrong, by an error or a warning. What is
    /// unconverged, exploded or stopped has to.
    bool is_reported = false;
    int frame = -1;    ///< in which it said so first; -1: at the start, or never
    std::string said;  ///< the first of it
    std::string why;   ///< the line of the criterion that does not hold; empty: none
    double strain_rms = 0.0, strain_max = 0.0;
    double ms_per_frame = 0.0;

    /// Wrong without a word.
    bool is_silent() const {
        return verdict != Verdict::kStable && verdict != Verdict::kDissipated && !is_reported;
    }
};

struct Row {
    Case what;
    Outcome outcome;
};

/// Runs a case with a solver on the options' devices. Whatever happens is an outcome.
Outcome run_case(const Case& what, const std::string& solver, const RunOptions& options);

}  // namespace weft::stability
