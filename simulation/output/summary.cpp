#include "simulation/output/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "runtime/error.h"

namespace weft {

namespace {

/// Nearest rank: the smallest value that `share` of all values do not exceed.
double quantile(std::vector<double> values, double share) {
    if (values.empty()) return 0.0;
    const double rank = std::ceil(share * static_cast<double>(values.size()));
    const std::size_t index = rank < 1.0 ? 0 : static_cast<std::size_t>(rank) - 1;
    const auto nth = values.begin() + static_cast<std::ptrdiff_t>(index);
    std::nth_element(values.begin(), nth, values.end());
    return *nth;
}

double median(const std::vector<double>& values) { return quantile(values, 0.5); }

double ratio(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

std::string bytes_text(std::uint64_t bytes) {
    const double value = static_cast<double>(bytes);
    if (bytes < 10'000) return fmt::format("{} B", bytes);
    if (bytes < 10'000'000) return fmt::format("{:.1f} kB", value / 1e3);
    return fmt::format("{:.1f} MB", value / 1e6);
}

void line(std::string& text, const std::string& label, const std::string& value) {
    text += fmt::format("{:<16} {}\n", label, value);
}

std::string devices_text(const RunSummary& summary) {
    std::string text;
    for (std::size_t i = 0; i < summary.devices.size(); ++i) {
        const RunSummary::Device& device = summary.devices[i];
        line(text, i == 0 ? "devices" : "",
             fmt::format("{}  {} ({}, {} unit{}): {:.3f} s in tasks, {:.1f} % of the makespan", i,
                         device.name, device.kind, device.units, device.units == 1 ? "" : "s",
                         device.busy, 100.0 * device.utilisation));
    }
    return text;
}

std::string energies_text(const RunSummary& summary) {
    std::string text;
    for (auto it = summary.energies.rbegin(); it != summary.energies.rend(); ++it) {
        text += fmt::format("{}{} {:.6g} J", text.empty() ? "" : ", ", it->first, it->second);
    }
    return text;
}

}  // namespace

SummaryBuilder::SummaryBuilder(const RunDescription& run) : energy_names_(run.energies) {
    summary_.scene = run.scene_name;
    for (const DeviceDescription& device : run.devices) {
        summary_.devices.push_back({device.name, device.kind, device.units, 0.0, 0.0});
    }
}

void SummaryBuilder::add(const FrameRecord& frame) {
    if (summary_.frames == 0) first_start_ = frame.start;
    ++summary_.frames;
    summary_.simulated_time = frame.sim_time;
    summary_.wall_time = frame.end - first_start_;
    summary_.transferred_bytes += frame.transferred_bytes;
    all_makespans_ += frame.measured_makespan;
    for (std::size_t i = 0; i < summary_.devices.size(); ++i) {
        summary_.devices[i].busy += frame.busy.at(i);
    }
    frame_times_.push_back(frame.end - frame.start);
    planned_.push_back(frame.planned_makespan);
    measured_.push_back(frame.measured_makespan);
    errors_.push_back(
        ratio(std::abs(frame.measured_makespan - frame.planned_makespan), frame.planned_makespan));
    bounds_.push_back(frame.lower_bound);
    plan_times_.push_back(frame.plan_time);

    double total = frame.kinetic_energy + frame.gravity_energy;
    summary_.energies = {{"kinetic", frame.kinetic_energy}, {"gravity", frame.gravity_energy}};
    for (std::size_t i = 0; i < energy_names_.size(); ++i) {
        summary_.energies.emplace_back(energy_names_[i], frame.energies.at(i));
        total += frame.energies[i];
    }
    summary_.energies.emplace_back("total", total);
}

RunSummary SummaryBuilder::summary() const {
    RunSummary result = summary_;
    result.frame_median = median(frame_times_);
    result.frame_p95 = quantile(frame_times_, 0.95);
    result.planned_makespan = median(planned_);
    result.measured_makespan = median(measured_);
    result.plan_error = median(errors_);
    result.lower_bound = median(bounds_);
    result.plan_time = median(plan_times_);
    for (RunSummary::Device& device : result.devices) {
        device.utilisation = ratio(device.busy, all_makespans_);
        result.utilisation += device.utilisation / static_cast<double>(result.devices.size());
    }
    return result;
}

nlohmann::ordered_json to_json(const RunSummary& summary) {
    nlohmann::ordered_json devices = nlohmann::ordered_json::array();
    for (const RunSummary::Device& device : summary.devices) {
        devices.push_back({{"name", device.name},
                           {"kind", device.kind},
                           {"units", device.units},
                           {"busy_s", device.busy},
                           {"utilisation", device.utilisation}});
    }
    nlohmann::ordered_json energies = nlohmann::ordered_json::object();
    for (const auto& [name, value] : summary.energies) energies[name] = value;
    nlohmann::ordered_json files = nlohmann::ordered_json::object();
    for (const auto& [what, path] : summary.files) files[what] = path;

    nlohmann::ordered_json json;
    json["scene"] = summary.scene;
    json["finished"] = summary.finished;
    json["frames"] = summary.frames;
    json["simulated_s"] = summary.simulated_time;
    json["wall_s"] = summary.wall_time;
    json["ms_per_frame"] = 1e3 * summary.frame_median;
    json["ms_p95"] = 1e3 * summary.frame_p95;
    json["devices"] = devices;
    if (!summary.losses.empty()) json["lost_devices"] = summary.losses;
    json["utilisation"] = summary.utilisation;
    json["planned_ms"] = 1e3 * summary.planned_makespan;
    json["measured_ms"] = 1e3 * summary.measured_makespan;
    json["plan_error"] = summary.plan_error;
    json["lower_bound_ms"] = 1e3 * summary.lower_bound;
    json["plan_us"] = 1e6 * summary.plan_time;
    json["transferred_bytes"] = summary.transferred_bytes;
    json["energy"] = summary.energies.empty() ? 0.0 : summary.energies.back().second;
    json["energies"] = energies;
    json["state_hash"] = summary.state_hash;
    json["files"] = files;
    return json;
}

std::string to_text(const RunSummary& summary) {
    std::string text;
    line(text, "scene", summary.scene);
    line(
        text, "frames",
        fmt::format("{} ({:.4g} s simulated) in {:.3f} s{}", summary.frames, summary.simulated_time,
                    summary.wall_time, summary.finished ? "" : "; not all of them"));
    if (summary.frames == 0) return text;
    line(text, "time per frame",
         fmt::format("median {:.3f} ms, p95 {:.3f} ms", 1e3 * summary.frame_median,
                     1e3 * summary.frame_p95));
    text += devices_text(summary);
    for (const std::string& loss : summary.losses) line(text, "lost", loss);
    line(text, "utilisation", fmt::format("{:.1f} %", 100.0 * summary.utilisation));
    line(text, "makespan",
         fmt::format("planned {:.3f} ms, measured {:.3f} ms (median error {:.1f} %), lower bound "
                     "{:.3f} ms",
                     1e3 * summary.planned_makespan, 1e3 * summary.measured_makespan,
                     100.0 * summary.plan_error, 1e3 * summary.lower_bound));
    line(text, "planner", fmt::format("{:.1f} us per frame", 1e6 * summary.plan_time));
    line(text, "transfers", bytes_text(summary.transferred_bytes));
    line(text, "energy", energies_text(summary));
    line(text, "state hash", summary.state_hash.empty() ? "not known" : summary.state_hash);
    for (const auto& [what, path] : summary.files) line(text, what, path);
    return text;
}

void write_summary(const std::filesystem::path& path, const RunSummary& summary) {
    // Beside it first, then renamed: nobody finds half of it.
    std::filesystem::path part = path;
    part += ".part";
    errno = 0;
    {
        std::ofstream stream(part, std::ios::binary);
        stream << to_json(summary).dump(2) << '\n' << std::flush;
        if (stream && !std::rename(part.c_str(), path.c_str())) return;
    }
    const std::string reason = errno != 0 ? std::strerror(errno) : "write failed";
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw RunError(path.string() + ": cannot write the summary: " + reason);
}

}  // namespace weft
