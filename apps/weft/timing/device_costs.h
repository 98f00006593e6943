#pragma once

#include <optional>

#include "runtime/device.h"

namespace weft {

/// Copies between the host's memory and a device's own: time = latency + bytes / bandwidth.
struct TransferCost {
    double latency = 0.0;    ///< [s], submission and waiting included
    double bandwidth = 0.0;  ///< [bytes/s]
};

/// What using a device costs, whatever the work.
struct DeviceCosts {
    double batch = 0.0;                     ///< one tiny task, submitted and waited for [s]
    double launch = 0.0;                    ///< each further task submitted along with it [s]
    std::optional<TransferCost> to_device;  ///< absent: it works in the host's memory
    std::optional<TransferCost> to_host;
};

/// Measures; takes a few tenths of a second. Throws RunError if the device fails.
DeviceCosts measure_costs(Device& device);

}  // namespace weft
