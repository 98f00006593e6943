#include "simulation/scene/body_keys.h"
#include "simulation/scene/elements/element_keys.h"
#include "simulation/scene/node_values.h"

namespace weft {

ElementKeys membranes_keys() {
    static const TableKeys table{{
        young_key(),
        poisson_key(),
        {.name = "thickness",
         .help = "of the sheet",
         .unit = "m",
         .required = true,
         .range = positive_up_to(1.0)},
    }};
    return {.of_cloth = {{.name = "membrane",
                          .type = Type::kTable,
                          .help = "the triangles as a thin sheet of elastic material (stable "
                                  "Neo-Hookean)",
                          .table = &table}},
            .holds_cloth = true,
            .read = [](const Node& cloth_table, Cloth& cloth) {
                if (const Node* membrane = cloth_table.find("membrane")) {
                    cloth.membrane = Membrane{
                        {number_value(*membrane, "young"), number_value(*membrane, "poisson")},
                        number_value(*membrane, "thickness")};
                }
            }};
}

}  // namespace weft
