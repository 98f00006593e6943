#include "simulation/scene/elements/element_keys.h"
#include "simulation/scene/node_values.h"

namespace weft {

ElementKeys hinges_keys() {
    static const TableKeys table{{
        {.name = "stiffness",
         .help = "bending stiffness; 0: no bending",
         .unit = "J",
         .required = true,
         .range = at_least(0.0)},
        {.name = "rest",
         .type = Type::kText,
         .help = "fold of every edge at rest: that of the cloth's rest shape, or none",
         .fallback = std::string("shape"),
         .choices = {"shape", "flat"}},
    }};
    return {.of_cloth = {{.name = "bend",
                          .type = Type::kTable,
                          .help = "bending over edges; default: no bending",
                          .table = &table}},
            .read = [](const Node& cloth_table, Cloth& cloth) {
                const Node* bend = cloth_table.find("bend");
                if (bend == nullptr) return;
                if (const auto stiffness = optional_number(*bend, "stiffness")) {
                    cloth.bend = Bend{*stiffness, text_value(*bend, "rest") == "flat"};
                }
            }};
}

}  // namespace weft
