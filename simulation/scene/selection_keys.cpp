#include "simulation/scene/selection_keys.h"

#include <string>
#include <utility>

#include "simulation/scene/limits.h"

namespace weft {
namespace {

const std::vector<std::string> kGridCorners{"x-z-", "x+z-", "x-z+", "x+z+"};
const std::vector<std::string> kBlockCorners{"x-y-z-", "x+y-z-", "x-y+z-", "x+y+z-",
                                             "x-y-z+", "x+y-z+", "x-y+z+", "x+y+z+"};

Key corners_key(std::vector<std::string> choices, std::string help) {
    return {.name = "corners",
            .type = Type::kText,
            .forms = {{kAny}},
            .help = std::move(help),
            .choices = std::move(choices)};
}

const Key& edges_key() {
    static const Key key{.name = "edges",
                         .type = Type::kText,
                         .forms = {{kAny}},
                         .help = "edges of a cloth's grid",
                         .choices = {"x-", "x+", "z-", "z+"}};
    return key;
}

const Key& rims_key() {
    static const Key key{.name = "rims",
                         .type = Type::kText,
                         .forms = {{kAny}},
                         .help = "rims of a cylinder",
                         .choices = {"top", "bottom"}};
    return key;
}

const Key& faces_key() {
    static const Key key{.name = "faces",
                         .type = Type::kText,
                         .forms = {{kAny}},
                         .help = "faces of a block",
                         .choices = {"x-", "x+", "y-", "y+", "z-", "z+"}};
    return key;
}

const Key& vertices_key() {
    static const Key key{.name = "vertices",
                         .type = Type::kInteger,
                         .forms = {{kAny}},
                         .help = "indices from 0, in the order of the mesh",
                         .range = between(0, static_cast<double>(kMaxVertices - 1))};
    return key;
}

const Key& parts_key() {
    static const Key key{.name = "parts",
                         .type = Type::kText,
                         .forms = {{kAny}},
                         .help = "named objects and groups of a cloth's OBJ file"};
    return key;
}

const Key& box_key() {
    static const Key key{
        .name = "box",
        .forms = {{2, 3}, {kAny, 2, 3}},
        .help =
            "all vertices that start inside [[low x, y, z], [high x, y, z]], or inside any of "
            "a list of these",
        .unit = "m"};
    return key;
}

}  // namespace

std::vector<Key> cloth_selection_keys() {
    return {corners_key(kGridCorners, "corners of a grid"),
            edges_key(),
            rims_key(),
            parts_key(),
            vertices_key(),
            box_key()};
}

std::vector<Key> solid_selection_keys() {
    return {corners_key(kBlockCorners, "corners of a block"), faces_key(), vertices_key(),
            box_key()};
}

std::vector<Key> any_selection_keys() {
    std::vector<std::string> corners = kGridCorners;
    corners.insert(corners.end(), kBlockCorners.begin(), kBlockCorners.end());
    return {corners_key(std::move(corners), "corners of a, if it is a grid or block"),
            edges_key(),
            rims_key(),
            faces_key(),
            parts_key(),
            vertices_key(),
            box_key()};
}

}  // namespace weft
