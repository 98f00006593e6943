#pragma once

#include "simulation/scene/document.h"
#include "simulation/scene/keys.h"

namespace weft {

/// Holds a document to its description: unknown keys, types, lengths, ranges, choices, required
/// keys. Then writes in the defaults and brings values of several forms to one, so that
/// node_values.h can read without asking. Throws UserError at the first mistake.
void validate(Node& root, const TableKeys& keys);

}  // namespace weft
