#include "runtime/planning/division_search.h"

#include <algorithm>
#include <cmath>

namespace weft {

namespace {

/// A division is worth a look of its own if a device has more strips more or less by it.
constexpr int kFarStrips = 2;
constexpr double kShortestTime = 1e-12;  ///< [s]

}  // namespace

DivisionSearch::DivisionSearch(int device_count, int strip_count, std::vector<int> devices,
                               Predict predict)
    : device_count_(device_count),
      strip_count_(strip_count),
      devices_(std::move(devices)),
      predict_(std::move(predict)) {}

Division DivisionSearch::single(int device) const {
    return Division::single(device_count_, strip_count_, device);
}

/// speeds  [devices_]; 0: no share
Division DivisionSearch::shares(const std::vector<double>& speeds) const {
    std::vector<double> able;
    std::ranges::copy_if(speeds, std::back_inserter(able), [](double s) { return s > 0.0; });
    const Division given = Division::proportional(strip_count_, able);
    Division division{std::vector<int>(static_cast<std::size_t>(device_count_), 0)};
    auto next = given.strips.begin();
    for (std::size_t i = 0; i < devices_.size(); ++i) {
        if (speeds[i] > 0.0) division.strips[static_cast<std::size_t>(devices_[i])] = *next++;
    }
    return division;
}

Division DivisionSearch::equal_shares() const {
    return shares(std::vector<double>(devices_.size(), 1.0));
}

Division DivisionSearch::by_speed() const {
    std::vector<double> speeds;
    for (const int d : devices_) {
        const double time = predict_(single(d));
        speeds.push_back(std::isfinite(time) ? 1.0 / std::max(time, kShortestTime) : 0.0);
    }
    const bool nobody = std::ranges::max(speeds) == 0.0;
    return nobody ? equal_shares() : shares(speeds);
}

bool DivisionSearch::improve(Division& mixture, double margin) const {
    double best = predict_(mixture) * (1.0 - margin);
    std::vector<Division> others = mixture.neighbours(devices_);
    if (Division far = by_speed(); far.distance(mixture) > kFarStrips) {
        others.push_back(std::move(far));
    }
    bool found = false;
    for (Division& other : others) {
        if (other.devices().size() < 2) continue;
        const double time = predict_(other);
        if (time >= best) continue;
        best = time;
        mixture = std::move(other);
        found = true;
    }
    return found;
}

Division DivisionSearch::best() const {
    Division best = single(devices_.front());
    const auto consider = [&](const Division& other) {
        if (predict_(other) < predict_(best)) best = other;
    };
    for (const int d : devices_) consider(single(d));
    Division mixture = by_speed();
    while (improve(mixture, 0.0)) {
    }
    consider(mixture);
    return best;
}

}  // namespace weft
