#include "simulation/scene/elements/element_keys.h"

namespace weft {

std::vector<ElementKeys> element_keys() {
#define WEFT_KEYS(name) name##_keys(),
    return {WEFT_ELEMENT_FAMILIES(WEFT_KEYS)};
#undef WEFT_KEYS
}

}  // namespace weft
