#pragma once

#include <functional>
#include <vector>

#include "runtime/planning/division.h"

namespace weft {

/// Looks for the division of the strips among some devices that is predicted to take least: by a
/// hill climb, from shares in proportion to the devices' speeds.
class DivisionSearch {
public:
    /// Seconds of a substep; infinite where a device would get what it cannot run.
    using Predict = std::function<double(const Division&)>;

    /// devices  that may get strips, of `device_count`
    DivisionSearch(int device_count, int strip_count, std::vector<int> devices, Predict predict);

    /// In proportion to what each device takes alone; nothing for those that cannot do it alone.
    Division by_speed() const;
    /// The same share for each.
    Division equal_shares() const;

    /// Takes the best of the mixture, its neighbours and, where that is far away (speeds have
    /// changed), by_speed(), if it is faster by more than the margin. Whether there was one.
    bool improve(Division& mixture, double margin) const;

    /// The best that is found, single devices included.
    Division best() const;

private:
    Division single(int device) const;
    Division shares(const std::vector<double>& speeds) const;

    int device_count_, strip_count_;
    std::vector<int> devices_;
    Predict predict_;
};

}  // namespace weft
