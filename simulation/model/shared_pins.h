#pragma once

#include <string>
#include <vector>

#include "simulation/mesh/triangle_mesh.h"
#include "simulation/scene/scene.h"

namespace weft {

/// Finds vertices of a body that are held by several of its pins which move differently: one of
/// these alone can lead such a vertex (the last one that has a motion), and its user may not know.
class SharedPins {
public:
    /// vertices: of the body
    explicit SharedPins(int vertices) : holder_(static_cast<std::size_t>(vertices)) {}

    /// pins: outlives this
    void add(int vertex, const PinGroup& pins);
    /// body: "cloth 'sheet'"
    void warn(const std::string& body, Warnings& warnings) const;

private:
    std::vector<const PinGroup*> holder_;  ///< [vertices] the first; null: none
    std::vector<int> shared_;              ///< may name one several times
};

}  // namespace weft
