#include "simulation/scene/elements/woven.h"

#include "simulation/scene/elements/element_keys.h"
#include "simulation/scene/node_values.h"

namespace weft {

namespace {

const TableKeys& woven_table() {
    static const TableKeys table{{
        {.name = "warp",
         .help = "force per width and strain along the warp threads",
         .unit = "N/m",
         .required = true,
         .range = positive()},
        {.name = "weft",
         .help = "force per width and strain along the weft threads",
         .unit = "N/m",
         .required = true,
         .range = positive()},
        {.name = "shear",
         .help = "force per width and angle between the threads",
         .unit = "N/m",
         .required = true,
         .range = positive()},
        {.name = "direction",
         .forms = {{3}},
         .help = "of the warp in the world at the start, any length; default: along x of a grid, "
                 "from top to bottom of a cylinder, along u of a mesh's texture coordinates"},
    }};
    return table;
}

void read_woven(const Node& cloth_table, Cloth& cloth) {
    const Node* table = cloth_table.find("woven");
    if (table == nullptr) return;
    Woven woven{number_value(*table, "warp"), number_value(*table, "weft"),
                number_value(*table, "shear"), std::nullopt};
    if (table->find("direction") != nullptr) {
        woven.direction = vec3_value(*table, "direction");
        if (length(*woven.direction) == 0.0) {
            throw value_error(*table, "direction", "must not be zero");
        }
    }
    cloth.elements.set(woven);
}

}  // namespace

ElementKeys woven_keys() {
    return {.of_cloth = {{.name = "woven",
                          .type = Type::kTable,
                          .help = "the triangles as a weave of warp and weft threads",
                          .table = &woven_table()}},
            .holds_cloth = true,
            .read = &read_woven};
}

}  // namespace weft
