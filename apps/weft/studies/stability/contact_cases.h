#pragma once

#include <vector>

#include "apps/weft/studies/stability/cases.h"

namespace weft::stability {

/// What touches what, with [contact]: a map of blocks on each other, and single cases.
void add_contacts(std::vector<Case>& cases);

}  // namespace weft::stability
