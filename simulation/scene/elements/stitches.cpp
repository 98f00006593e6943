#include "simulation/scene/elements/element_keys.h"

namespace weft {

/// A [[seam]] is made of them.
ElementKeys stitches_keys() { return {}; }

}  // namespace weft
