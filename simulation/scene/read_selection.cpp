#include "simulation/scene/read_selection.h"

#include <algorithm>
#include <array>
#include <string>
#include <variant>

#include "simulation/scene/node_values.h"

namespace weft {
namespace {

std::vector<Box3> read_boxes(const Node& pins) {
    std::vector<Box3> boxes;
    const Node* list = pins.find("box");
    if (!list) return boxes;
    for (const Node& corners : list->array()) {
        const Box3 box{vec3_of(corners.array()[0]), vec3_of(corners.array()[1])};
        if (box.low.x > box.high.x || box.low.y > box.high.y || box.low.z > box.high.z) {
            throw value_error(pins, "box", "the first corner must be the lower one on every axis");
        }
        boxes.push_back(box);
    }
    return boxes;
}

/// Whether its corners and faces have names.
bool is_whole_block(const Shape& shape) {
    const auto* block = std::get_if<BlockShape>(&shape);
    return block != nullptr && block->outline.empty();
}

bool has_corner(const Shape& shape, const std::string& corner) {
    const bool is_of_block = corner.size() == 6;  // "x-y-z-", while a grid's are "x-z-"
    return is_of_block ? is_whole_block(shape) : std::holds_alternative<GridShape>(shape);
}

}  // namespace

void read_selection(const Node& table, const Shape& shape, Selection& selection) {
    selection.where = table.mark.text();
    selection.corners = text_values(table, "corners");
    selection.edges = text_values(table, "edges");
    selection.rims = text_values(table, "rims");
    selection.faces = text_values(table, "faces");
    selection.parts = text_values(table, "parts");
    selection.vertices = integer_values(table, "vertices");
    selection.boxes = read_boxes(table);
    for (const std::string& corner : selection.corners) {
        if (!has_corner(shape, corner)) {
            throw value_error(table, "corners",
                              corner.size() == 6
                                  ? "only a solid's grid has such corners, and none with an "
                                    "outline; use vertices or box"
                                  : "only a grid has corners; use vertices or box");
        }
    }
    if (!selection.edges.empty() && !std::holds_alternative<GridShape>(shape)) {
        throw value_error(table, "edges", "only a cloth's grid has edges; use vertices or box");
    }
    if (!selection.rims.empty() && !std::holds_alternative<CylinderShape>(shape)) {
        throw value_error(table, "rims", "only a cylinder has rims; use vertices or box");
    }
    if (!selection.faces.empty() && !is_whole_block(shape)) {
        throw value_error(table, "faces",
                          "only a solid's grid has faces, and none with an outline; use "
                          "vertices or box");
    }
    if (!selection.parts.empty() && !std::holds_alternative<MeshFile>(shape)) {
        throw value_error(table, "parts",
                          "only a cloth's mesh file has parts; use vertices or box");
    }
}

bool has_selection(const Node& table) {
    constexpr std::array kKeys{"corners", "edges", "rims", "faces", "parts", "vertices", "box"};
    return std::ranges::any_of(kKeys, [&](const char* key) { return table.find(key) != nullptr; });
}

bool names_any(const Selection& selection) {
    return !selection.corners.empty() || !selection.edges.empty() || !selection.rims.empty() ||
           !selection.faces.empty() || !selection.parts.empty() || !selection.vertices.empty() ||
           !selection.boxes.empty();
}

}  // namespace weft
