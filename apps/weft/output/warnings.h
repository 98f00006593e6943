#pragma once

#include <string>

#include "simulation/mesh/triangle_mesh.h"
#include "simulation/simulation.h"

namespace weft {

// What a run tells of its frames.
std::string text_of(const Trouble& trouble);
std::string text_of(const LostDevice& lost, const Simulation& simulation);

/// "weft: warning: ..." on stderr, each.
void print_warnings(const Warnings& warnings);

/// Likewise, if the user's cache folder cannot be used.
void warn_of_cache_folder();

}  // namespace weft
