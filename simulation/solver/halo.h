#pragma once

#include <utility>
#include <vector>

#include "simulation/model/model.h"

namespace weft {

/// Which positions the elements of a range of vertices read.
class Halo {
public:
    explicit Halo(const Model& model);

    /// The range of vertices that share an element with one of [begin, end), and those themselves.
    std::pair<int, int> around(int begin, int end) const;

private:
    std::vector<int> lowest_, highest_;  ///< [vertices] that share an element with it
};

}  // namespace weft
