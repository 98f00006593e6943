#include "simulation/scene/auto_method.h"

#include "simulation/scene/overrides.h"

namespace weft {

std::optional<AutoMethod> auto_method(const Scene& scene) {
    if (scene.text.empty()) return std::nullopt;
    Node root = parse_toml(scene.text, scene.path);
    std::vector<Override> overrides;
    for (const std::string& value : scene.overrides) overrides.push_back({value, value});
    apply_overrides(root, overrides);
    const Node* solver = root.find("solver");
    const Node* method = solver != nullptr ? solver->find("method") : nullptr;
    const auto* name = method != nullptr ? std::get_if<std::string>(&method->value) : nullptr;
    if (name == nullptr || *name != kAutoMethod) return std::nullopt;
    AutoMethod found;
    if (const Node* iterations = solver->find("iterations")) {
        found.iterations = static_cast<int>(std::get<std::int64_t>(iterations->value));
    }
    return found;
}

}  // namespace weft
