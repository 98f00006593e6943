#include "simulation/scene/read_connections.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <variant>

#include "runtime/near_miss.h"
#include "simulation/scene/node_values.h"
#include "simulation/scene/read_selection.h"

namespace weft {
namespace {

const Shape* find_shape(const Scene& scene, const std::string& name) {
    for (const Cloth& cloth : scene.cloths) {
        if (cloth.name == name) return &cloth.shape;
    }
    for (const Solid& solid : scene.solids) {
        if (solid.name == name) return &solid.shape;
    }
    return nullptr;
}

const Shape& named_shape(const Node& table, std::string_view key, const Scene& scene) {
    const std::string name = text_value(table, key);
    if (const Shape* shape = find_shape(scene, name)) return *shape;
    std::vector<std::string> names;
    for (const Cloth& cloth : scene.cloths) names.push_back(cloth.name);
    for (const Solid& solid : scene.solids) names.push_back(solid.name);
    throw value_error(table, key,
                      "no cloth or solid has this name; " + near_miss_or_list(name, names));
}

Attachment read_attachment(const Node& table, const Scene& scene) {
    Attachment attachment;
    attachment.where = table.mark.text();
    attachment.a = text_value(table, "a");
    attachment.b = text_value(table, "b");
    const Shape& shape = named_shape(table, "a", scene);
    named_shape(table, "b", scene);
    if (attachment.a == attachment.b) {
        throw value_error(table, "b", "must be another cloth or solid than a");
    }
    read_selection(table, shape, attachment.selected);
    if (!names_any(attachment.selected)) {
        throw value_error(table, "a", std::string("say which of its vertices: ") + kSelectionKeys);
    }
    attachment.stiffness = number_value(table, "stiffness");
    if (table.find("reach")) attachment.reach = number_value(table, "reach");
    return attachment;
}

const Cloth& named_cloth(const Node& table, const Scene& scene) {
    const std::string name = text_value(table, "cloth");
    std::vector<std::string> names;
    for (const Cloth& cloth : scene.cloths) {
        if (cloth.name == name) return cloth;
        names.push_back(cloth.name);
    }
    throw value_error(table, "cloth", "no cloth has this name; " + near_miss_or_list(name, names));
}

SeamSide read_seam_side(const Node& table, const Scene& scene) {
    SeamSide side;
    const Cloth& cloth = named_cloth(table, scene);
    side.cloth = cloth.name;
    read_selection(table, cloth.shape, side.selected);
    if (names_any(side.selected)) return side;
    throw value_error(table, "cloth",
                      "say which of its vertices: edges, rims, parts, vertices or box");
}

/// Welding makes vertices of one mesh one, so that its triangles and folds go on over the seam.
void check_weld(const Node& table, const Seam& seam, const Scene& scene) {
    for (const char* key : {"stiffness", "time"}) {
        if (!table.find(key)) continue;
        throw value_error(table, key,
                          "cannot stand beside weld = true, which has no stitches; leave out "
                          "either");
    }
    if (seam.a.cloth != seam.b.cloth) {
        throw value_error(table, "weld",
                          fmt::format("joins edges of one cloth, and these are of '{}' and '{}'; "
                                      "put both into one mesh file, or leave weld out and give "
                                      "stiffness and time: then stitches hold them together",
                                      seam.a.cloth, seam.b.cloth));
    }
    const auto cloth = std::ranges::find(scene.cloths, seam.a.cloth, &Cloth::name);
    require_weldable(table, cloth->shape);
}

Seam read_seam(const Node& table, const Scene& scene) {
    Seam seam{read_seam_side(*table.find("a"), scene), read_seam_side(*table.find("b"), scene), 0.0,
              0.0, table.mark.text()};
    if (truth_value(table, "weld")) {
        check_weld(table, seam, scene);
        return seam;
    }
    for (const char* key : {"stiffness", "time"}) {
        if (table.find(key)) continue;
        throw value_error(table, key, "is missing: a seam has stiffness and time, or weld = true");
    }
    seam.stiffness = number_value(table, "stiffness");
    seam.time = number_value(table, "time");
    return seam;
}

}  // namespace

void require_weldable(const Node& table, const Shape& shape) {
    if (std::holds_alternative<MeshFile>(shape)) return;
    throw value_error(table, "weld",
                      "only a mesh file has several vertices in one place; leave it out");
}

std::vector<Attachment> read_attachments(const Node& root, const Scene& scene) {
    std::vector<Attachment> attachments;
    const Node* list = root.find("attachment");
    if (!list) return attachments;
    for (const Node& table : list->array()) attachments.push_back(read_attachment(table, scene));
    return attachments;
}

void read_seams(const Node& root, Scene& scene) {
    const Node* list = root.find("seam");
    if (!list) return;
    for (const Node& table : list->array()) {
        Seam seam = read_seam(table, scene);
        if (seam.time > 0.0) {
            scene.seams.push_back(std::move(seam));
            continue;
        }
        const auto cloth = std::ranges::find(scene.cloths, seam.a.cloth, &Cloth::name);
        cloth->welds.push_back(
            {std::move(seam.a.selected), std::move(seam.b.selected), std::move(seam.where)});
    }
}

}  // namespace weft
