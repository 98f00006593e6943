#pragma once

#include <span>
#include <vector>

#include "runtime/planning/partition.h"

namespace weft {

/// Who gets how many strips: device d takes the strips behind those of the devices before it. A
/// device with none takes no part.
struct Division {
    std::vector<int> strips;  ///< [device], sums to the strip count

    static Division single(int device_count, int strip_count, int device);
    /// Shares in proportion to the devices' speeds, at least one strip each where there are enough.
    static Division proportional(int strip_count, std::span<const double> speeds);

    /// The devices that take part, in order: region r of the step is for device devices()[r].
    std::vector<int> devices() const;
    /// For StepMaker::make_step(): a part for each device that takes part.
    Partition partition() const;
    /// One bit per device that takes part.
    unsigned mask() const;
    /// The most strips that a device has more or less in the other one.
    int distance(const Division& other) const;
    /// Every division that differs by one strip handed to the next one of these devices, or back.
    std::vector<Division> neighbours(std::span<const int> among) const;

    friend auto operator<=>(const Division&, const Division&) = default;
};

}  // namespace weft
