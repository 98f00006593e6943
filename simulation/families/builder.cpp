#include "simulation/families/builder.h"

namespace weft {

std::vector<std::unique_ptr<FamilyBuilder>> make_family_builders() {
    std::vector<std::unique_ptr<FamilyBuilder>> builders;
#define WEFT_MAKE(name) builders.push_back(make_##name##_builder());
    WEFT_ELEMENT_FAMILIES(WEFT_MAKE)
#undef WEFT_MAKE
    return builders;
}

}  // namespace weft
