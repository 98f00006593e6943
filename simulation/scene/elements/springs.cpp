#include "simulation/scene/elements/element_keys.h"
#include "simulation/scene/node_values.h"

namespace weft {

ElementKeys springs_keys() {
    static const TableKeys table{{
        {.name = "stiffness",
         .help = "of the spring along each edge",
         .unit = "N/m",
         .required = true,
         .range = positive()},
    }};
    return {.of_cloth = {{.name = "stretch",
                          .type = Type::kTable,
                          .help = "springs along the edges",
                          .table = &table}},
            .holds_cloth = true,
            .read = [](const Node& cloth_table, Cloth& cloth) {
                if (const Node* stretch = cloth_table.find("stretch")) {
                    cloth.stretch.stiffness = number_value(*stretch, "stiffness");
                }
            }};
}

}  // namespace weft
