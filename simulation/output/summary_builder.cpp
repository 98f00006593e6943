#include "simulation/output/summary_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <tuple>
#include <utility>

#include "runtime/error.h"
#include "scheduler/order_statistics.h"

namespace weft {

namespace {

using scheduler::quantile;

double median(const std::vector<double>& values) { return quantile(values, 0.5); }

double ratio(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

/// What a checkpoint keeps of a record: these members, as an array in this order.
template <class Record, class... Members>
class KeptArray {
public:
    explicit constexpr KeptArray(Members Record::*... members) : members_(members...) {}

    nlohmann::json save(const Record& record) const {
        nlohmann::json array = nlohmann::json::array();
        const auto add = [&](auto... member) { (array.emplace_back(record.*member), ...); };
        std::apply(add, members_);
        return array;
    }
    void restore(const nlohmann::json& array, Record& record) const {
        std::size_t i = 0;
        const auto set = [&](auto... member) { (array.at(i++).get_to(record.*member), ...); };
        std::apply(set, members_);
    }

    nlohmann::json save_all(const std::vector<Record>& records) const {
        nlohmann::json arrays = nlohmann::json::array();
        for (const Record& record : records) arrays.push_back(save(record));
        return arrays;
    }
    /// Behind those that there are.
    void restore_all(const nlohmann::json& arrays, std::vector<Record>& records) const {
        for (const auto& array : arrays) restore(array, records.emplace_back());
    }

private:
    std::tuple<Members Record::*...> members_;
};

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
    if (frame.gained > summary_.gained) {
        summary_.gained = frame.gained;
        summary_.gained_frame = frame.frame;
    }
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

/// The records that a checkpoint keeps.
struct SummaryBuilder::Kept {
    static constexpr KeptArray kAccount{&RunSummary::work, &RunSummary::dissipated,
                                        &RunSummary::gained, &RunSummary::gained_frame};
    static constexpr KeptArray kStrain{&RunSummary::strain_rms, &RunSummary::strain_frame,
                                       &RunSummary::strain_max, &RunSummary::strain_rms_at_end};
    static constexpr KeptArray kContact{
        &RunSummary::Contact::pairs,     &RunSummary::Contact::touching,
        &RunSummary::Contact::truncated, &RunSummary::Contact::truncated_frame,
        &RunSummary::Contact::lost,      &RunSummary::Contact::substeps_wanted,
        &RunSummary::Contact::redone,    &RunSummary::Contact::least_distance};
    static constexpr KeptArray kDevice{&RunSummary::Device::name, &RunSummary::Device::kind,
                                       &RunSummary::Device::units, &RunSummary::Device::busy};
    static constexpr KeptArray kEstimate{&Estimate::frame, &Estimate::relative_error};
    static constexpr KeptArray kFrame{&Frame::start,    &Frame::end,         &Frame::planned,
                                      &Frame::measured, &Frame::lower_bound, &Frame::parts};
};

std::vector<std::uint8_t> SummaryBuilder::save() const {
    nlohmann::json contact;
    if (summary_.contact) contact = Kept::kContact.save(*summary_.contact);
    return nlohmann::json::to_cbor({{"simulated_time", summary_.simulated_time},
                                    {"transferred_bytes", summary_.transferred_bytes},
                                    {"settings", summary_.settings},
                                    {"energies", summary_.energies},
                                    {"account", Kept::kAccount.save(summary_)},
                                    {"strain", Kept::kStrain.save(summary_)},
                                    {"contact", std::move(contact)},
                                    {"warnings", summary_.warnings},
                                    {"estimates", Kept::kEstimate.save_all(estimates_)},
                                    {"devices", Kept::kDevice.save_all(summary_.devices)},
                                    {"frames", Kept::kFrame.save_all(frames_)}});
}

void SummaryBuilder::restore(std::span<const std::uint8_t> saved) {
    try {
        const auto json = nlohmann::json::from_cbor(saved.begin(), saved.end());
        json.at("simulated_time").get_to(summary_.simulated_time);
        json.at("transferred_bytes").get_to(summary_.transferred_bytes);
        json.at("energies").get_to(summary_.energies);
        json.at("warnings").get_to(summary_.warnings);
        Kept::kAccount.restore(json.at("account"), summary_);
        Kept::kStrain.restore(json.at("strain"), summary_);
        const auto& contact = json.at("contact");
        if (!contact.is_null()) Kept::kContact.restore(contact, summary_.contact.emplace());
        Kept::kEstimate.restore_all(json.at("estimates"), estimates_);
        std::vector<RunSummary::Device> devices;
        Kept::kDevice.restore_all(json.at("devices"), devices);
        for (const RunSummary::Device& device : devices) restore_device(device);
        Kept::kFrame.restore_all(json.at("frames"), frames_);
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

}  // namespace weft
