#pragma once

namespace weft {

enum class PlanKind {
    kAuto,    ///< whatever is predicted to be the fastest of all these
    kExact,   ///< always a mixture: the strips are divided among the devices
    kPlaced,  ///< each task on the device that suits it
    kSingle,  ///< the best single device
};

}  // namespace weft
