#pragma once

#include <optional>
#include <string>

namespace weft {

/// How asynchronous iterations exchange (docs/asynchronous-gauss-seidel.md). Together with the cuts
/// they decide the result.
struct AsyncSettings {
    /// What becomes of a vertex that two devices have moved from where both had it.
    enum class Merge {
        kAuto,      ///< what the solver needs
        kSum,       ///< both motions in full
        kMean,      ///< half of each
        kPosition,  ///< the mean of the positions, also where only one has moved
    };
    enum class Tasks {
        kStrips,  ///< every device does its strips
        /// As the paper has it: a task does one kind of work, everywhere; HEFT says which device.
        kKinds,
    };
    /// What may overlap; what may not sees what comes before it.
    enum class Order {
        kBoth,    ///< tasks of one iteration and of several, but obstacles come last in theirs
        kFree,    ///< obstacles come when they come
        kWithin,  ///< tasks of one iteration, but obstacles come last
        kAcross,  ///< those of several iterations
    };
    Tasks tasks = Tasks::kStrips;
    Order order = Order::kBoth;
    bool rank = true;            ///< kKinds: later iterations come later, as the solver has them
    int window = 2;              ///< iterations that are open at a time; 1: synchronous
    std::optional<double> wait;  ///< until another device is told [iterations]; null: window - 1
    Merge merge = Merge::kAuto;
    bool dropping = false;  ///< scheduler/exchange_map.h
    /// So many of the last iterations are synchronous; null: 1 where there are obstacles or
    /// contact.
    std::optional<int> settle;

    double wait_or_default() const { return wait.value_or(window - 1.0); }
    friend bool operator==(const AsyncSettings&, const AsyncSettings&) = default;
};

/// As in "window=3,wait=0.5,merge=sum,dropping=on,settle=1"; what is not named has its default.
/// Throws UserError.
AsyncSettings parse_async_settings(const std::string& text);
/// All of them, as they can be parsed.
std::string to_text(const AsyncSettings& settings);

}  // namespace weft
