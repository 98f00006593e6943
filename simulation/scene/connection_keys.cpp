#include "simulation/scene/connection_keys.h"

#include <string>
#include <utility>
#include <vector>

#include "simulation/scene/selection_keys.h"

namespace weft {
namespace {

TableKeys with_selection(std::vector<Key> keys, const std::vector<Key>& selection) {
    keys.insert(keys.end(), selection.begin(), selection.end());
    return {std::move(keys)};
}

const TableKeys& seam_side_table() {
    static const TableKeys table = with_selection(
        {{.name = "cloth", .type = Type::kText, .help = "name of the cloth", .required = true}},
        cloth_selection_keys());
    return table;
}

Key seam_side_key(std::string name, std::string help) {
    return {.name = std::move(name),
            .type = Type::kTable,
            .help = std::move(help),
            .required = true,
            .table = &seam_side_table()};
}

}  // namespace

const TableKeys& attachment_table() {
    static const TableKeys table = with_selection(
        {
            {.name = "a",
             .type = Type::kText,
             .help = "name of the cloth or solid whose vertices are tied",
             .required = true},
            {.name = "b",
             .type = Type::kText,
             .help = "name of another one: each vertex is tied to the nearest vertex of this",
             .required = true},
            {.name = "stiffness",
             .help =
                 "of each spring that ties two vertices; its rest length is their distance at the "
                 "start",
             .unit = "N/m",
             .required = true,
             .range = positive()},
            {.name = "reach",
             .help =
                 "selected vertices that have nothing of b nearer than this stay free; default: no "
                 "limit",
             .unit = "m",
             .range = between(0.0, 1e6)},
        },
        any_selection_keys());
    return table;
}

const TableKeys& seam_table() {
    static const TableKeys table{{
        seam_side_key("a",
                      "one edge: the selected vertices at the border of a cloth, or vertices "
                      "listed one by one"),
        seam_side_key("b", "the other edge, of the same cloth or another one"),
        {.name = "stiffness",
         .help = "of each stitch; with time, or instead of both weld",
         .unit = "N/m",
         .range = positive()},
        {.name = "time",
         .help = "until the edges are together; then the stitches hold",
         .unit = "s",
         .range = {.low = 1e-6, .high = 1e6}},
        {.name = "weld",
         .type = Type::kBoolean,
         .help = "the edges, of one cloth and in one place at time 0, become one edge",
         .fallback = false},
    }};
    return table;
}

}  // namespace weft
