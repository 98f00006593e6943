#pragma once

#include <optional>
#include <string>

#include "runtime/trace/records.h"
#include "simulation/model/model.h"

namespace weft {

/// Whether a run ends with energy that it cannot have. Where nothing from outside does work (no
/// moving pins or obstacles, no seams that close, constant gravity), what moves and strains at the
/// end was there at the start, or came from the fall. Steps that are not solved far enough may make
/// much more of it, with every number finite.
class EnergyCheck {
public:
    /// start: the energies of the state that the run begins with [J]
    EnergyCheck(const Model& model, const FrameRecord& start);

    /// A warning, or nothing.
    std::optional<std::string> look(const FrameRecord& end) const;

private:
    bool is_closed_;
    double start_;  ///< all energies together [J]
    double small_;  ///< lost in rounding [J]
};

}  // namespace weft
