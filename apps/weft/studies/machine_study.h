#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace weft {

/// Which machines that need not be there a recorded frame is planned for. Half of their devices (of
/// an odd number the smaller half) are faster than the others, which are the one that was measured.
struct MachineGrid {
    std::vector<double> waits{1e-6, 3e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3};  ///< [s]
    std::vector<double> ratios{1, 2, 5, 10, 20};
    std::vector<int> devices{2, 3, 4, 6, 8};
};

/// What it is that a fast device does so many times faster.
enum class FasterAt {
    kEverything,
    kOneKind,  ///< the kind of task that takes most of the time
};
inline constexpr std::array kFasterAt{FasterAt::kEverything, FasterAt::kOneKind};
std::string name_of(FasterAt faster);

/// In the order in which one is preferred to the next if it is as good.
enum class Winner { kSingle, kExact, kPlaced, kAsync };
inline constexpr std::array kWinners{Winner::kSingle, Winner::kExact, Winner::kPlaced,
                                     Winner::kAsync};
std::string name_of(Winner winner);

/// One machine, and what each kind of plan is predicted to take there: seconds of a substep,
/// infinite where there is no such plan.
struct MachineRow {
    FasterAt faster = FasterAt::kEverything;
    int devices = 0;
    double ratio = 1.0;
    double wait = 0.0;  ///< from a task's end to the start of one on another device [s]
    std::array<double, kWinners.size()> time{};
    /// Of the asynchronous plan: the window that is best there, and how many times the iterations
    /// it needs for the same error. `time` holds that.
    int window = 0;
    double more_iterations = 1.0;

    /// The first that is not beaten by more than kMargin.
    Winner winner() const;
    static constexpr double kMargin = 0.01;
};

struct MachineStudy {
    std::string scene;
    std::uint32_t frame = 0;
    std::string device;     ///< that was measured
    std::string fast_kind;  ///< that fast devices are good at, with FasterAt::kOneKind
    int vertices = 0;
    int strips = 0;
    int iterations = 0;
    std::vector<MachineRow> rows;
};

/// Throws UserError for a trace whose scene cannot be made anew, or that has no costs.
MachineStudy study_machines(const std::string& trace, std::optional<std::uint32_t> frame,
                            const MachineGrid& grid, bool quiet);

std::string to_csv(const MachineStudy& study);
/// A map of letters for each number of devices.
std::string to_text(const MachineStudy& study);
nlohmann::ordered_json to_json(const MachineStudy& study);

}  // namespace weft
