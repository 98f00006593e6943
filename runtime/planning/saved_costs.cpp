#include "runtime/planning/saved_costs.h"

#include <unistd.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "kernels/sources.h"
#include "runtime/io/cache_folder.h"
#include "runtime/io/json_text.h"

namespace weft {

namespace {

using Json = nlohmann::json;

constexpr const char* kFormat = "weft-costs 1";

const std::string& kernels_digest() {
    static const std::string digest = [] {
        std::string text = __VERSION__;  // compiles them for the CPU
        for (const auto& file : kernels::source_files()) text += file.text;
        return cache_key(text);
    }();
    return digest;
}

/// A driver names the model of its device; for the CPU itself the machine stands, since several
/// machines may share a home folder.
std::string driver_of(const DeviceInfo& device) {
    if (!device.driver.empty()) return device.driver;
    char host[256] = "";
    ::gethostname(host, sizeof host - 1);
    return host;
}

std::string device_key(const DeviceInfo& device, bool strict) {
    std::string key = device.kind + '|' + device.name + '|' + driver_of(device) + '|' +
                      std::to_string(device.units) + '|' + std::string(name_of(device.memory)) +
                      '|' + std::to_string(device.lanes);
    if (!strict) key += "|fast";
    return key;
}

/// The kind is told by what its tasks run: other work may number kinds alike.
std::string fit_key(const TaskBody& body, const DeviceInfo& device, bool strict) {
    std::string key = device_key(device, strict) + '|' + kernels_digest() + '|' + body.name;
    for (const Launch& launch : body.launches) key += '|' + std::string(launch.kernel->name);
    return key;
}

std::string link_key(const DeviceInfo& from, const DeviceInfo& to, bool strict) {
    return device_key(from, strict) + " -> " + device_key(to, strict);
}

/// Calls f(kind, body) once for each kind.
template <class F>
void for_each_kind(std::span<const TaskBody* const> bodies, const F& f) {
    std::vector<bool> seen;
    for (const TaskBody* body : bodies) {
        const auto kind = static_cast<std::size_t>(body->kind);
        if (seen.size() <= kind) seen.resize(kind + 1, false);
        if (seen[kind]) continue;
        seen[kind] = true;
        f(static_cast<std::uint32_t>(kind), *body);
    }
}

bool is_cost(double value) { return std::isfinite(value) && value >= 0.0; }

}  // namespace

SavedCosts::SavedCosts(std::filesystem::path path) : path_(std::move(path)) { read(); }

bool SavedCosts::restore(std::span<const TaskBody* const> bodies,
                         const std::vector<Device*>& devices, bool strict,
                         TimingModel& timing) const {
    bool all = true;
    for (std::size_t d = 0; d < devices.size(); ++d) {
        for_each_kind(bodies, [&](std::uint32_t kind, const TaskBody& body) {
            const auto known = fits_.find(fit_key(body, devices[d]->info(), strict));
            if (known == fits_.end()) {
                all = false;
                return;
            }
            timing.costs().restore(kind, static_cast<std::uint32_t>(d), known->second);
        });
        for (std::size_t to = 0; to < devices.size(); ++to) {
            if (to == d) continue;
            const auto known =
                latencies_.find(link_key(devices[d]->info(), devices[to]->info(), strict));
            if (known == latencies_.end()) {
                all = false;
                continue;
            }
            timing.set_latency(static_cast<int>(d), static_cast<int>(to), known->second);
        }
    }
    return all;
}

void SavedCosts::save(std::span<const TaskBody* const> bodies, const std::vector<Device*>& devices,
                      bool strict, const TimingModel& timing) {
    const CacheLock lock(path_);
    read();
    for (std::size_t d = 0; d < devices.size(); ++d) {
        for_each_kind(bodies, [&](std::uint32_t kind, const TaskBody& body) {
            const auto& fit = timing.costs().fit(kind, static_cast<std::uint32_t>(d));
            if (fit.frames > 0) fits_[fit_key(body, devices[d]->info(), strict)] = fit;
        });
        for (std::size_t to = 0; to < devices.size(); ++to) {
            if (to == d) continue;
            latencies_[link_key(devices[d]->info(), devices[to]->info(), strict)] =
                timing.latency(static_cast<int>(d), static_cast<int>(to));
        }
    }
    write();
}

void SavedCosts::keep() {
    const CacheLock lock(path_);
    read();
    write();
}

void SavedCosts::read() {
    const Json json = Json::parse(read_cached(path_), nullptr, false);
    if (!json.is_object() || !json.contains("format") || json["format"] != kFormat) return;
    try {
        for (const auto& [key, value] : json.at("fits").items()) {
            const scheduler::CostFit fit{
                {value.at("fixed").get<double>(), value.at("per_item").get<double>()},
                value.at("spread").get<double>(),
                value.at("frames").get<std::uint32_t>()};
            if (is_cost(fit.cost.fixed) && is_cost(fit.cost.per_item)) fits_[key] = fit;
        }
        for (const auto& [key, value] : json.at("latencies").items()) {
            if (is_cost(value.get<double>())) latencies_[key] = value.get<double>();
        }
    } catch (const Json::exception&) {
        // Written by something else: what could be read up to here is still true.
    }
}

void SavedCosts::write() const {
    Json json{{"format", kFormat}, {"fits", Json::object()}, {"latencies", latencies_}};
    for (const auto& [key, fit] : fits_) {
        json["fits"][key] = {{"fixed", fit.cost.fixed},
                             {"per_item", fit.cost.per_item},
                             {"spread", fit.spread},
                             {"frames", fit.frames}};
    }
    write_cached(path_, json_text(json, 1) + '\n');
}

}  // namespace weft
