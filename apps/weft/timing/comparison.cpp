#include "apps/weft/timing/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "runtime/split.h"
#include "scheduler/order_statistics.h"

namespace weft {

namespace {

double quantile(const std::vector<FrameSample>& frames, double FrameSample::*value, double part) {
    std::vector<double> values;
    for (const FrameSample& frame : frames) values.push_back(frame.*value);
    return scheduler::quantile(std::move(values), part);
}

const ComparisonRow* find_row(const std::vector<ComparisonRow>& rows, const std::string& devices) {
    const auto row = std::find_if(rows.begin(), rows.end(),
                                  [&](const ComparisonRow& r) { return r.devices == devices; });
    return row == rows.end() ? nullptr : &*row;
}

/// Device lists end in the same state, and so mostly say the same.
Warnings each_once(const std::vector<ComparisonRow>& rows) {
    Warnings all;
    for (const ComparisonRow& row : rows) {
        std::ranges::copy_if(row.warnings, std::back_inserter(all), [&](const std::string& text) {
            return std::ranges::find(all, text) == all.end();
        });
    }
    return all;
}

}  // namespace

std::vector<std::string> devices_of(const std::string& list) { return split(list, '+'); }

ComparisonRow make_row(const std::string& devices, const std::vector<FrameSample>& frames,
                       const EndState& end) {
    const auto mixed =
        std::count_if(frames.begin(), frames.end(), [](const FrameSample& f) { return f.mixed; });
    ComparisonRow row;
    row.devices = devices;
    row.plan = 2 * static_cast<std::size_t>(mixed) > frames.size() ? "mixture" : "single";
    row.ms_per_frame = quantile(frames, &FrameSample::wall, 0.5);
    row.ms_p95 = quantile(frames, &FrameSample::wall, 0.95);
    row.planned_ms = quantile(frames, &FrameSample::planned, 0.5);
    row.measured_ms = quantile(frames, &FrameSample::measured, 0.5);
    row.plan_us = 1e3 * quantile(frames, &FrameSample::plan, 0.5);
    row.utilisation = quantile(frames, &FrameSample::utilisation, 0.5);
    row.energy = end.energy;
    row.state_hash = end.hash;
    row.is_async = end.is_async;
    row.warnings = end.warnings;
    return row;
}

Comparison compare_rows(const std::string& scene, std::vector<ComparisonRow> rows) {
    Warnings warnings = each_once(rows);
    Comparison comparison{scene, std::move(rows), {}, {}, {}, std::move(warnings)};
    const auto mixture =
        std::find_if(comparison.rows.rbegin(), comparison.rows.rend(),
                     [](const ComparisonRow& r) { return devices_of(r.devices).size() > 1; });
    if (mixture == comparison.rows.rend()) return comparison;

    const ComparisonRow* best = nullptr;
    double speeds = 0.0;
    for (const std::string& device : devices_of(mixture->devices)) {
        const ComparisonRow* row = find_row(comparison.rows, device);
        if (row == nullptr) return comparison;  // not compared with all of its own devices
        speeds += 1.0 / row->ms_per_frame;
        if (best == nullptr || row->ms_per_frame < best->ms_per_frame) best = row;
    }
    comparison.best_single = best->devices;
    comparison.speedup_over_best_single = best->ms_per_frame / mixture->ms_per_frame;
    comparison.efficiency = 1.0 / mixture->ms_per_frame / speeds;
    return comparison;
}

nlohmann::ordered_json to_json(const Comparison& comparison) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const ComparisonRow& r : comparison.rows) {
        rows.push_back({{"devices", r.devices},
                        {"plan", r.plan},
                        {"ms_per_frame", r.ms_per_frame},
                        {"ms_p95", r.ms_p95},
                        {"planned_ms", r.planned_ms},
                        {"measured_ms", r.measured_ms},
                        {"plan_us", r.plan_us},
                        {"utilisation", r.utilisation},
                        {"energy", r.energy},
                        {"state_hash", r.state_hash}});
    }
    nlohmann::ordered_json json{{"scene", comparison.scene}, {"rows", std::move(rows)}};
    const auto set = [&](const char* key, const auto& value) {
        if (value)
            json[key] = *value;
        else
            json[key] = nullptr;
    };
    set("best_single", comparison.best_single);
    set("speedup_over_best_single", comparison.speedup_over_best_single);
    set("efficiency", comparison.efficiency);
    json["warnings"] = comparison.warnings;
    return json;
}

std::string to_text(const Comparison& comparison) {
    std::size_t width = 7;
    for (const ComparisonRow& r : comparison.rows) width = std::max(width, r.devices.size());
    std::string text = fmt::format("{:<{}}  {:>9} {:>9} {:>9} {:>9} {:>8} {:>5} {:>12}  {:<8} {}\n",
                                   "devices", width, "ms/frame", "p95", "planned", "measured",
                                   "plan us", "util", "energy J", "plan", "state");
    for (const ComparisonRow& r : comparison.rows) {
        text += fmt::format(
            "{:<{}}  {:9.3f} {:9.3f} {:9.3f} {:9.3f} {:8.1f} {:4.0f}% {:12.6g}  {:<8} {}\n",
            r.devices, width, r.ms_per_frame, r.ms_p95, r.planned_ms, r.measured_ms, r.plan_us,
            100.0 * r.utilisation, r.energy, r.plan, r.state_hash.substr(0, 8));
    }
    if (comparison.efficiency) {
        text += fmt::format("{:.2f} times as fast as {} alone; efficiency {:.2f}\n",
                            *comparison.speedup_over_best_single, *comparison.best_single,
                            *comparison.efficiency);
    }
    return text;
}

}  // namespace weft
