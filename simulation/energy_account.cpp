#include "simulation/energy_account.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "simulation/families/convert.h"
#include "simulation/start_checks.h"

namespace weft {

namespace {

// Beyond what sweeps of few iterations do in scenes that look as they should: their strain has a
// few times the energy that it should have while edges are hardly longer, their motion has not.
constexpr double kMostMotion = 2.0;
constexpr double kMostStrain = 10.0;
constexpr double kVisibleStrain = 0.05;  ///< of edges, RMS
constexpr double kTornStrain = 1.0;      ///< of one edge
// And what no such sweep does.
constexpr double kExplodingMotion = 10.0;
constexpr double kExplodingStrain = 1000.0;

constexpr double kSmallFall = 0.01;  ///< of the size of everything
constexpr double kRounding = 4.0 * static_cast<double>(std::numeric_limits<float>::epsilon());

/// The diagonal of the box around all vertices [m].
double size_of(const Model& model) {
    Vec3 low, high;
    for (std::size_t v = 0; v < model.positions->count(); ++v) {
        const Vec3 x = to_vec3((*model.positions)[v]);
        if (v == 0) low = high = x;
        low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
        high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
    }
    return length(high - low);
}

double last_closing(const Scene& scene) {
    double last = 0.0;
    for (const Seam& seam : scene.seams) last = std::max(last, seam.time);
    return last;
}

double mass_of(const Model& model) {
    return std::accumulate(model.masses.begin(), model.masses.end(), 0.0);
}

/// What the elements have more of where every coordinate is off by its last bits [J].
double energy_of_rounding(const Model& model, double reach) {
    std::vector<float4> off(model.positions->span().begin(), model.positions->span().end());
    const auto step = static_cast<float>(kRounding * reach);
    for (std::size_t v = 0; v < off.size(); ++v) {
        const auto sign = [&](std::size_t k) { return (v * 7919 + k) % 5 < 3 ? step : -step; };
        off[v] = {off[v].x + sign(0), off[v].y + sign(1), off[v].z + sign(3), off[v].w};
    }
    double sum = 0.0;
    for (const auto& family : model.families) {
        sum += std::abs(family->total_energy(off) - family->total_energy(model.positions->span()));
    }
    const double speed = kRounding * reach / model.h;
    return sum + 0.5 * mass_of(model) * speed * speed;
}

}  // namespace

double reach_of(std::span<const float4> positions) {
    float most = 0.0f;
    for (const float4& x : positions) {
        most = std::max({most, std::abs(x.x), std::abs(x.y), std::abs(x.z)});
    }
    return static_cast<double>(most);
}

EnergyAccount::EnergyAccount(const Model& model, const Energies& start)
    : closed_(last_closing(model.scene)),
      small_(kSmallFall * size_of(model) * length(model.scene.gravity_at(0.0)) * mass_of(model) +
             energy_inside_obstacles(model)) {
    const double reach = reach_of(model.positions->span());
    rounding_ = reach > 0.0 ? energy_of_rounding(model, reach) / (reach * reach) : 0.0;
    last_.start = start.total();
    last_.energies = start;
}

EnergyAccount::Entry EnergyAccount::with_frame(double time, const OutsideWork& outside,
                                               const Energies& end, double found) const {
    if (time < closed_) return {end.total(), {}, end, false};
    Entry entry{last_.start + found, last_.outside, end, true};
    entry.outside.work += outside.work;
    entry.outside.doubt += outside.doubt;
    return entry;
}

double EnergyAccount::small(double reach) const { return small_ + rounding_ * reach * reach; }

std::optional<EnergyAlarm> EnergyAccount::look(const Entry& entry, const Strain& strain,
                                               double reach) const {
    if (!entry.is_known) return std::nullopt;
    const double outside = entry.outside.work + entry.outside.doubt;
    const double had = std::max(entry.start + outside - entry.energies.gravity, 0.0);
    const double enough = had + small(reach);
    const double motion = entry.energies.kinetic;
    const double strained = entry.energies.strain();
    const bool is_visible = strain.rms > kVisibleStrain || strain.most > kTornStrain;
    const bool is_fine =
        motion <= kMostMotion * enough && (strained <= kMostStrain * enough || !is_visible);
    if (is_fine) return std::nullopt;
    const bool explodes =
        motion > kExplodingMotion * enough || (strained > kExplodingStrain * enough && is_visible);
    return EnergyAlarm{
        fmt::format("energy from nowhere: {:.3g} J of motion and {:.3g} J of strain (edges: {:.3g} "
                    "% RMS), where {:.3g} J were to be had",
                    motion, strained, 100.0 * strain.rms, had),
        explodes};
}

void EnergyAccount::forgive() {
    last_.start = last_.energies.total();
    last_.outside = {};
}

std::array<double, 4> EnergyAccount::save() const {
    return {last_.start, last_.outside.work, last_.outside.doubt,
            last_.energies.contact.value_or(0.0)};
}

void EnergyAccount::restore(const std::array<double, 4>& saved, Energies now) {
    if (now.contact) now.contact = saved[3];
    last_ = {saved[0], {saved[1], saved[2]}, std::move(now), true};
}

}  // namespace weft
