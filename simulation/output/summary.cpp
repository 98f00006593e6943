#include "simulation/output/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "runtime/io/json_text.h"
#include "runtime/io/whole_file.h"

namespace weft {

namespace {

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

nlohmann::ordered_json pairs_json(const TextPairs& pairs) {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    for (const auto& [key, value] : pairs) json[key] = value;
    return json;
}

nlohmann::ordered_json parts_json(const RunSummary& summary) {
    nlohmann::ordered_json json;
    for (std::size_t p = 0; p < summary.parts.size(); ++p)
        json[kFrameParts[p].name] = 1e3 * summary.parts[p];
    return json;
}

std::string parts_text(const RunSummary& summary) {
    std::string text;
    for (std::size_t p = 0; p < summary.parts.size(); ++p) {
        text += fmt::format("{}{} {:.3f}", text.empty() ? "" : ", ", kFrameParts[p].name,
                            1e3 * summary.parts[p]);
    }
    return text + " ms";
}

double plan_time(const RunSummary& summary) {
    const auto* part = std::ranges::find(kFrameParts, &FrameRecord::plan_time, &FramePart::time);
    return summary.parts[static_cast<std::size_t>(part - kFrameParts)];
}

std::string strain_text(const RunSummary& summary) {
    return fmt::format("RMS {:.3g} % at the end, {:.3g} % in frame {}; {:.3g} % of the worst edge",
                       100.0 * summary.strain_rms_at_end, 100.0 * summary.strain_rms,
                       summary.strain_frame, 100.0 * summary.strain_max);
}

std::string convergence_text(const RunSummary& summary) {
    if (summary.estimates == 0) return "not estimated";
    return fmt::format(
        "estimated relative error of a step {:.2g} (median of {} frame{}), at worst {:.2g} in "
        "frame {}",
        summary.relative_error, summary.estimates, summary.estimates == 1 ? "" : "s",
        summary.worst_relative_error, summary.worst_error_frame);
}

nlohmann::ordered_json convergence_json(const RunSummary& summary) {
    if (summary.estimates == 0) return nullptr;
    return {{"median", summary.relative_error},
            {"worst", summary.worst_relative_error},
            {"worst_frame", summary.worst_error_frame},
            {"frames", summary.estimates}};
}

std::string contact_text(const RunSummary::Contact& contact) {
    std::string text = fmt::format(
        "up to {} pairs, {} vertices nearer than the thickness, least distance {:.3g} m",
        contact.pairs, contact.touching, contact.least_distance);
    if (contact.redone > 0) text += fmt::format("; {} frames run again", contact.redone);
    if (contact.truncated == 0) return text;
    return text + fmt::format("; {} vertices taken back in frame {}: some {} substeps would do",
                              contact.truncated, contact.truncated_frame, contact.substeps_wanted);
}

nlohmann::ordered_json contact_json(const RunSummary::Contact& contact) {
    return {{"pairs", contact.pairs},
            {"touching", contact.touching},
            {"truncated", contact.truncated},
            {"truncated_frame", contact.truncated_frame},
            {"lost", contact.lost},
            {"substeps_wanted", contact.substeps_wanted},
            {"redone_frames", contact.redone},
            {"least_distance", contact.least_distance}};
}

std::string energies_text(const RunSummary& summary) {
    std::string text;
    for (auto it = summary.energies.rbegin(); it != summary.energies.rend(); ++it) {
        text += fmt::format("{}{} {:.6g} J", text.empty() ? "" : ", ", it->first, it->second);
    }
    if (!std::isnan(summary.dissipated)) {
        text += fmt::format("; done by what moves {:.6g} J, dissipated {:.6g} J", summary.work,
                            summary.dissipated);
    }
    if (summary.gained > 0.0) {
        text += fmt::format(", from nowhere up to {:.3g} J in frame {}", summary.gained,
                            summary.gained_frame);
    }
    return text;
}

}  // namespace

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
    json["parts_ms"] = parts_json(summary);
    json["devices"] = devices;
    json["warnings"] = summary.warnings;
    if (!summary.losses.empty()) json["lost_devices"] = summary.losses;
    json["utilisation"] = summary.utilisation;
    json["planned_ms"] = 1e3 * summary.planned_makespan;
    json["measured_ms"] = 1e3 * summary.measured_makespan;
    json["plan_error"] = summary.plan_error;
    json["lower_bound_ms"] = 1e3 * summary.lower_bound;
    json["plan_us"] = 1e6 * plan_time(summary);
    json["transferred_bytes"] = summary.transferred_bytes;
    json["energy"] = summary.energies.empty() ? 0.0 : summary.energies.back().second;
    json["energies"] = energies;
    json["work"] = summary.work;
    json["dissipated"] = summary.dissipated;
    json["gained"] = summary.gained;
    json["gained_frame"] = summary.gained_frame;
    json["strain_rms"] = summary.strain_rms;
    json["strain_frame"] = summary.strain_frame;
    json["strain_max"] = summary.strain_max;
    json["strain_rms_at_end"] = summary.strain_rms_at_end;
    json["relative_error_estimate"] = convergence_json(summary);
    if (summary.contact) json["contact"] = contact_json(*summary.contact);
    json["state_hash"] = summary.state_hash;
    json["files"] = files;
    json["command"] = summary.command;
    json["settings"] = pairs_json(summary.settings);
    json["made_from"] = summary.made_from;
    json["host"] = pairs_json(summary.host);
    json["versions"] = pairs_json(summary.versions);
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
    line(text, "of which", parts_text(summary));
    text += devices_text(summary);
    for (const std::string& warning : summary.warnings) line(text, "warning", warning);
    for (const std::string& loss : summary.losses) line(text, "lost", loss);
    line(text, "utilisation", fmt::format("{:.1f} %", 100.0 * summary.utilisation));
    line(text, "makespan",
         fmt::format("planned {:.3f} ms, measured {:.3f} ms (median error {:.1f} %), lower bound "
                     "{:.3f} ms",
                     1e3 * summary.planned_makespan, 1e3 * summary.measured_makespan,
                     100.0 * summary.plan_error, 1e3 * summary.lower_bound));
    line(text, "planner", fmt::format("{:.1f} us per frame", 1e6 * plan_time(summary)));
    line(text, "transfers", bytes_text(summary.transferred_bytes));
    line(text, "energy", energies_text(summary));
    line(text, "strain of edges", strain_text(summary));
    if (summary.contact) line(text, "contact", contact_text(*summary.contact));
    line(text, "convergence", convergence_text(summary));
    line(text, "state hash", summary.state_hash.empty() ? "not known" : summary.state_hash);
    for (const auto& [what, path] : summary.files) line(text, what, path);
    return text;
}

void write_summary(const std::filesystem::path& path, const RunSummary& summary) {
    write_whole_file(path, json_text(to_json(summary)) + '\n', " the summary");
}

}  // namespace weft
