#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/weft/run/run_options.h"
#include "apps/weft/studies/stability/cases.h"

namespace weft::stability {

/// What `weft stability` is asked to do.
struct StudyOptions {
    RunOptions run;
    std::vector<std::string> solvers;  ///< empty: all
    std::string only;                  ///< words in "group: name"; empty: all cases
    std::string one_case;              ///< a case's whole "group: name"; empty: all cases
    bool is_short = false;             ///< only what the tests run
    double time = 300.0;               ///< [s] of trying settings of a scene
    bool as_sweep = false;             ///< nothing is run: a sweep is made that does
};

/// Those that are asked for, at least one. Throws UserError.
std::vector<Case> chosen_cases(const StudyOptions& options);

/// What --case takes.
std::string full_name(const Case& what);

/// The sweep file that does the study: a run per case and solver, or, with a scene, per solver.
/// `weft batch --collect` joins what they find.
/// folder  that the file will be in
std::string sweep_text(const StudyOptions& options, const std::string& name,
                       const std::filesystem::path& folder);

}  // namespace weft::stability
