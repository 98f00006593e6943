#pragma once

#include <cstdint>
#include <vector>

#include "scheduler/cost_model.h"

namespace weft::scheduler {

/// How tasks have changed since a device last ran some of their kind. Work whose items are not
/// alike (contacts that come to press, rows that get longer) takes another time per item than it
/// did, and a device that is out of use knows nothing of that. Those in use do: it takes as many
/// times what they take now as it did when it was last seen, of as many items as it ran then.
class CostDrift {
public:
    CostDrift(std::uint32_t kinds, std::uint32_t devices);

    /// Ends a frame, behind costs.refit().
    void note(const CostModel& costs);

    /// Predicted seconds, as costs.predict(), which it is where the kind was observed on the device
    /// as lately as on any other one, or nothing is known of that.
    double predict(const CostModel& costs, std::uint32_t kind, std::uint32_t device,
                   double items) const;

private:
    std::size_t index(std::uint32_t kind, std::uint32_t device, std::uint32_t other) const {
        return (std::size_t{kind} * devices_ + device) * devices_ + other;
    }

    std::uint32_t kinds_, devices_;
    /// [kind][device][other] the other's cost when the kind was last observed on the device; 0: it
    /// is not known.
    std::vector<LinearCost> then_;
    std::vector<std::uint32_t> seen_;  ///< [kind][device] frames in a row in which it was observed
};

}  // namespace weft::scheduler
