#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "simulation/model/model.h"

namespace weft {

/// Which positions the elements of a range of vertices read. Ranges begin and end where strips or
/// seams do.
class Halo {
public:
    explicit Halo(const Model& model);

    /// The range of vertices that share an element with one of [begin, end), and those themselves.
    std::pair<int, int> around(int begin, int end) const;

private:
    std::size_t piece(int vertex) const;

    std::vector<int> borders_;           ///< [pieces + 1] of strips and of seams, ascending
    std::vector<int> lowest_, highest_;  ///< [pieces] that share an element with one of it
};

}  // namespace weft
