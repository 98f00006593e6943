#include "simulation/scene/elements/element_keys.h"

namespace weft {

/// `bend` describes them, too: they are those of its hinges that are folded at rest.
ElementKeys curved_hinges_keys() { return {}; }

}  // namespace weft
