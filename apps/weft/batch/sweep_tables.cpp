#include "apps/weft/batch/sweep_tables.h"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/error.h"
#include "runtime/near_miss.h"

namespace weft::batch {

void fail(const Node& node, const std::string& key, const std::string& what) {
    throw UserError(fmt::format("{}: {} = {}: {}", node.mark.text(), key, node.describe(), what));
}

void check_known(const Mark& mark, const std::string& key, const std::vector<std::string>& known) {
    if (std::ranges::find(known, key) != known.end()) return;
    throw UserError(
        fmt::format("{}: unknown key '{}'; {}", mark.text(), key, near_miss_or_list(key, known)));
}

void check_members(const Node& table, const std::vector<std::string>& known) {
    for (const Member& member : table.table()) check_known(member.mark, member.key, known);
}

const Node& required(const Node& table, const std::string& key) {
    const Node* node = table.find(key);
    if (node != nullptr) return *node;
    throw UserError(fmt::format("{}: '{}' is missing", table.mark.text(), key));
}

std::string text_of(const Node& node, const std::string& key) {
    const auto* text = std::get_if<std::string>(&node.value);
    if (text == nullptr || text->empty()) fail(node, key, "expected a text");
    return *text;
}

std::vector<Node> tables(const Node& root, const std::string& key) {
    const Node* node = root.find(key);
    if (node == nullptr) return {};
    if (!node->is_array()) fail(*node, key, fmt::format("expected [[{}]]", key));
    for (const Node& table : node->array()) {
        if (!table.is_table()) fail(table, key, fmt::format("expected [[{}]]", key));
    }
    return node->array();
}

}  // namespace weft::batch
