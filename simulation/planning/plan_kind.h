#pragma once

namespace weft {

enum class PlanKind {
    kAuto,    ///< the mixture of all devices or a single one, whichever is predicted to be faster
    kExact,   ///< always the mixture
    kSingle,  ///< the best single device
};

}  // namespace weft
