#include "simulation/scene/elements/element_keys.h"

namespace weft {

/// A [[solid]] is made of them, and has their material among its own keys.
ElementKeys tetrahedra_keys() { return {}; }

}  // namespace weft
