#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/weft/timing/frame_worker.h"

namespace weft {

/// What one device list took; times are medians over the frames [ms].
struct ComparisonRow {
    std::string devices;
    std::string plan;           ///< what the planner mostly chose: "mixture" or "single"
    double ms_per_frame = 0.0;  ///< wall time
    double ms_p95 = 0.0;
    double planned_ms = 0.0;  ///< makespan
    double measured_ms = 0.0;
    double plan_us = 0.0;
    double utilisation = 0.0;
    double energy = 0.0;  ///< at the end [J]
    std::string state_hash;
    bool is_async = false;  ///< the state depends on how the devices share the work
    Warnings warnings;
};

/// frames: those that count.
ComparisonRow make_row(const std::string& devices, const std::vector<FrameSample>& frames,
                       const EndState& end);

/// Table 1 of the paper, for one scene.
struct Comparison {
    std::string scene;
    std::vector<ComparisonRow> rows;
    /// The mixture is the last row of several devices; its devices are the rows that its list
    /// names.
    std::optional<std::string> best_single;  ///< the fastest of the mixture's devices alone
    std::optional<double> speedup_over_best_single;
    std::optional<double> efficiency;  ///< the mixture's speed / the sum of its devices' own speeds
    Warnings warnings;                 ///< of the rows, each once
};

Comparison compare_rows(const std::string& scene, std::vector<ComparisonRow> rows);
nlohmann::ordered_json to_json(const Comparison& comparison);
std::string to_text(const Comparison& comparison);

/// The elements of a device list: "a+b" -> {"a", "b"}.
std::vector<std::string> devices_of(const std::string& list);

}  // namespace weft
