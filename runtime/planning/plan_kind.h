#pragma once

namespace weft {

enum class PlanKind {
    kAuto,    ///< whatever is predicted to be the fastest of all these
    kExact,   ///< always a mixture: the strips are divided among the devices
    kPlaced,  ///< each task on the device that suits it
    /// A mixture whose results depend on the cuts: these are made by the devices' units, which do
    /// not change from run to run.
    kAsync,
    kSingle,  ///< the best single device
};

}  // namespace weft
