#pragma once

#include "simulation/scene/keys.h"

/// Parts of the table in keys.h: what holds bodies together, or a cloth to itself.
namespace weft {

const TableKeys& attachment_table();
const TableKeys& seam_table();

}  // namespace weft
