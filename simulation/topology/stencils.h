#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace weft {

/// All elements of one kind as a flat table: springs (arity 2), triangles (3), hinges and
/// tetrahedra (4).
struct Stencils {
    int arity = 2;
    std::vector<int> vertices;  ///< [arity * count()], the vertices of element 0, element 1, ...

    int count() const {
        return static_cast<int>(vertices.size() / static_cast<std::size_t>(arity));
    }

    std::span<const int> operator[](int element) const {
        const auto size = static_cast<std::size_t>(arity);
        return {vertices.data() + static_cast<std::size_t>(element) * size, size};
    }
};

}  // namespace weft
