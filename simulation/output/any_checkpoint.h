#pragma once

#include "simulation/output/checkpoint.h"
#include "simulation/output/summary.h"

namespace weft {

/// A checkpoint of whatever run. Throws UserError if it is missing, none, or damaged.
Checkpoint read_any_checkpoint(const std::filesystem::path& path);

/// The settings of the run that a checkpoint is of, as in its trace. Throws UserError where the
/// checkpoint has none.
TextPairs settings_of(const Checkpoint& checkpoint, const std::filesystem::path& path);

}  // namespace weft
