#include "simulation/output/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "runtime/error.h"
#include "runtime/io/json_text.h"
#include "runtime/io/whole_file.h"
#include "scheduler/order_statistics.h"

namespace weft {

namespace {

using scheduler::quantile;

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

RunSummary::Contact contact_from(const nlohmann::json& json) {
    return {json.at(0), json.at(1), json.at(2), json.at(3),
            json.at(4), json.at(5), json.at(6), json.at(7)};
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
    return text;
}

}  // namespace

SummaryBuilder::SummaryBuilder(const RunDescription& run)
    : energy_names_(run.energies), device_count_(run.devices.size()) {
    summary_.scene = run.scene_name;
    summary_.command = run.command;
    summary_.settings = run.settings;
    summary_.host = run.host;
    summary_.versions = run.versions;
    for (const DeviceDescription& device : run.devices) {
        const auto size = std::ranges::count(run.devices, device.team, &DeviceDescription::team);
        summary_.devices.push_back(
            {device.name, device.kind, device.units, 0.0, 0.0, 1.0 / static_cast<double>(size)});
    }
}

void SummaryBuilder::add(const FrameRecord& frame) {
    Frame& kept = frames_.emplace_back(Frame{frame.start,
                                             frame.end,
                                             frame.planned_makespan,
                                             frame.measured_makespan,
                                             frame.lower_bound,
                                             {}});
    std::ranges::transform(kFrameParts, kept.parts.begin(),
                           [&](const FramePart& part) { return frame.*part.time; });
    summary_.simulated_time = frame.sim_time;
    summary_.transferred_bytes += frame.transferred_bytes;
    for (std::size_t i = 0; i < device_count_; ++i) summary_.devices[i].busy += frame.busy.at(i);
    set_energies(frame);
    add_strain(frame);
    add_contact(frame);
    if (std::isfinite(frame.relative_error)) {
        estimates_.push_back({frame.frame, frame.relative_error});
    }
}

void SummaryBuilder::sum_up_estimates(RunSummary& summary) const {
    summary.estimates = estimates_.size();
    if (estimates_.empty()) return;
    std::vector<double> errors;
    for (const Estimate& e : estimates_) errors.push_back(e.relative_error);
    summary.relative_error = median(errors);
    const auto worst = std::ranges::max_element(estimates_, {}, &Estimate::relative_error);
    summary.worst_relative_error = worst->relative_error;
    summary.worst_error_frame = worst->frame;
}

void SummaryBuilder::add_strain(const FrameRecord& frame) {
    if (frames_.size() == 1 || frame.strain_rms > summary_.strain_rms) {
        summary_.strain_rms = frame.strain_rms;
        summary_.strain_frame = frame.frame;
    }
    summary_.strain_max = std::max(summary_.strain_max, frame.strain_max);
    summary_.strain_rms_at_end = frame.strain_rms;
}

void SummaryBuilder::add_contact(const FrameRecord& frame) {
    for (const ContactRecord& record : frame.contacts) {
        if (!summary_.contact) {
            summary_.contact.emplace().least_distance = std::numeric_limits<double>::infinity();
        }
        RunSummary::Contact& all = *summary_.contact;
        if (record.truncated > all.truncated) all.truncated_frame = frame.frame;
        all.pairs = std::max(all.pairs, record.pairs);
        all.touching = std::max(all.touching, record.touching);
        all.truncated = std::max(all.truncated, record.truncated);
        all.lost = std::max(all.lost, record.lost);
        all.substeps_wanted = std::max(all.substeps_wanted, record.substeps_wanted);
        all.redone += record.redone > 0 ? 1 : 0;
        all.least_distance = std::min(all.least_distance, record.least_distance);
    }
}

void SummaryBuilder::set_energies(const FrameRecord& frame) {
    double total = frame.kinetic_energy + frame.gravity_energy;
    summary_.energies = {{"kinetic", frame.kinetic_energy}, {"gravity", frame.gravity_energy}};
    for (std::size_t i = 0; i < energy_names_.size(); ++i) {
        summary_.energies.emplace_back(energy_names_[i], frame.energies.at(i));
        total += frame.energies[i];
    }
    summary_.energies.emplace_back("total", total);
    summary_.work = frame.work;
    summary_.dissipated = frame.dissipated;
}

RunSummary SummaryBuilder::summary() const {
    RunSummary result = summary_;
    result.frames = frames_.size();
    if (frames_.empty()) return result;
    const auto all = [&](auto value) {
        std::vector<double> values;
        for (const Frame& frame : frames_) values.push_back(value(frame));
        return values;
    };
    const std::vector<double> times = all([](const Frame& f) { return f.end - f.start; });
    const std::vector<double> measured = all([](const Frame& f) { return f.measured; });
    result.wall_time = frames_.back().end - frames_.front().start;
    result.frame_median = median(times);
    result.frame_p95 = quantile(times, 0.95);
    result.planned_makespan = median(all([](const Frame& f) { return f.planned; }));
    result.measured_makespan = median(measured);
    result.plan_error = median(
        all([](const Frame& f) { return ratio(std::abs(f.measured - f.planned), f.planned); }));
    result.lower_bound = median(all([](const Frame& f) { return f.lower_bound; }));
    for (std::size_t p = 0; p < result.parts.size(); ++p)
        result.parts[p] = median(all([p](const Frame& f) { return f.parts[p]; }));
    const double makespans = std::accumulate(measured.begin(), measured.end(), 0.0);
    for (RunSummary::Device& device : result.devices) {
        device.utilisation = ratio(device.busy, makespans);
        result.utilisation += device.utilisation * device.share;
    }
    sum_up_estimates(result);
    return result;
}

std::vector<std::uint8_t> SummaryBuilder::save() const {
    nlohmann::json devices = nlohmann::json::array();
    for (const RunSummary::Device& d : summary_.devices)
        devices.push_back({d.name, d.kind, d.units, d.busy});
    nlohmann::json frames = nlohmann::json::array();
    for (const Frame& f : frames_)
        frames.push_back({f.start, f.end, f.planned, f.measured, f.lower_bound, f.parts});
    nlohmann::json estimates = nlohmann::json::array();
    for (const Estimate& e : estimates_) estimates.push_back({e.frame, e.relative_error});
    nlohmann::json contact;
    if (summary_.contact) {
        const RunSummary::Contact& c = *summary_.contact;
        contact = {c.pairs, c.touching,        c.truncated, c.truncated_frame,
                   c.lost,  c.substeps_wanted, c.redone,    c.least_distance};
    }
    return nlohmann::json::to_cbor({{"simulated_time", summary_.simulated_time},
                                    {"transferred_bytes", summary_.transferred_bytes},
                                    {"settings", summary_.settings},
                                    {"energies", summary_.energies},
                                    {"account", {summary_.work, summary_.dissipated}},
                                    {"strain",
                                     {summary_.strain_rms, summary_.strain_frame,
                                      summary_.strain_max, summary_.strain_rms_at_end}},
                                    {"contact", std::move(contact)},
                                    {"warnings", summary_.warnings},
                                    {"estimates", std::move(estimates)},
                                    {"devices", std::move(devices)},
                                    {"frames", std::move(frames)}});
}

void SummaryBuilder::restore(std::span<const std::uint8_t> saved) {
    try {
        const auto json = nlohmann::json::from_cbor(saved.begin(), saved.end());
        json.at("simulated_time").get_to(summary_.simulated_time);
        json.at("transferred_bytes").get_to(summary_.transferred_bytes);
        json.at("energies").get_to(summary_.energies);
        json.at("warnings").get_to(summary_.warnings);
        json.at("account").at(0).get_to(summary_.work);
        json.at("account").at(1).get_to(summary_.dissipated);
        const auto& strain = json.at("strain");
        strain.at(0).get_to(summary_.strain_rms);
        strain.at(1).get_to(summary_.strain_frame);
        strain.at(2).get_to(summary_.strain_max);
        strain.at(3).get_to(summary_.strain_rms_at_end);
        const auto& contact = json.at("contact");
        if (!contact.is_null()) summary_.contact = contact_from(contact);
        for (const auto& e : json.at("estimates")) estimates_.push_back({e.at(0), e.at(1)});
        for (const auto& d : json.at("devices"))
            restore_device({d.at(0), d.at(1), d.at(2), d.at(3)});
        for (const auto& f : json.at("frames")) {
            frames_.push_back({f.at(0), f.at(1), f.at(2), f.at(3), f.at(4), {}});
            f.at(5).get_to(frames_.back().parts);
        }
    } catch (const nlohmann::json::exception&) {
        throw UserError("the checkpoint's report cannot be read; --force starts the run anew");
    }
}

void SummaryBuilder::restore_device(const RunSummary::Device& device) {
    const auto now = std::span(summary_.devices).first(device_count_);
    const auto same = std::ranges::find_if(now, [&](const RunSummary::Device& d) {
        return d.name == device.name && d.kind == device.kind && d.units == device.units &&
               d.busy == 0.0;
    });
    if (same != now.end())
        same->busy = device.busy;
    else if (device.busy > 0.0)
        summary_.devices.push_back(device);
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
