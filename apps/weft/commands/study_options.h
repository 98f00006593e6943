#pragma once

#include "apps/weft/studies/error_study.h"
#include "apps/weft/studies/stability/stability_study.h"

namespace CLI {
class App;
}

/// The options of studies, without what belongs to a command alone: `weft batch make` looks with
/// them at what a sweep's runs will be told.
namespace weft {

void add_error_options(CLI::App& command, ErrorOptions& options);
void add_stability_options(CLI::App& command, stability::StudyOptions& options);

}  // namespace weft
