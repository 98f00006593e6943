#pragma once

#include <vector>

#include "simulation/element_families.h"
#include "simulation/scene/document.h"
#include "simulation/scene/keys.h"
#include "simulation/scene/scene.h"

namespace weft {

/// How a scene describes a family of elements: what element_families.h calls x_keys().
struct ElementKeys {
    std::vector<Key> of_cloth{};  ///< keys of [[cloth]]
    bool holds_cloth = false;     ///< a cloth with the first of them needs nothing else
    /// Reads what a [[cloth]] table has of them. Throws UserError. Null: there is nothing to read
    void (*read)(const Node& table, Cloth& cloth) = nullptr;
};

#define WEFT_DECLARE(name) ElementKeys name##_keys();
WEFT_ELEMENT_FAMILIES(WEFT_DECLARE)
#undef WEFT_DECLARE

/// Of all families, in the order of the list.
std::vector<ElementKeys> element_keys();

}  // namespace weft
