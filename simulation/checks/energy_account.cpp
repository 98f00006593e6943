#include "simulation/checks/energy_account.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "simulation/checks/start_checks.h"
#include "simulation/families/convert.h"

namespace weft {

namespace {

// Beyond what sweeps of few iterations do in scenes that look as they should: their strain has a
// few times the energy that it should have while edges are hardly longer, their motion has not.
// Where edges are far longer, nothing looks as it should, and strain has no more excuse than
// motion.
constexpr double kMostMotion = 2.0;
constexpr double kMostStrain = 10.0;
constexpr double kVisibleStrain = 0.05;  ///< of edges, RMS
constexpr double kVisibleStrainOfSolids = 0.02;
constexpr double kMostHiddenStrainOfSolids = 4.0;
constexpr double kTornStrain = 1.0;  ///< of one edge
// What contacts have stored is seen as little in edges as it has to do with them.
constexpr double kMostInContacts = 10.0;
constexpr double kMostInTies = 10.0;  ///< likewise
// And what no such sweep does.
constexpr double kExplodingMotion = 10.0;
constexpr double kExplodingStrain = 1000.0;

constexpr double kSmallFall = 0.01;  ///< of the size of everything
// What is higher than all energy there was could lift it is excused by no strain that is not seen.
constexpr double kSmallLift = 0.0025;  ///< likewise
constexpr double kRounding = static_cast<double>(std::numeric_limits<float>::epsilon());

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

/// What it takes to lift everything by its own size [J].
double lift_by_size(const Model& model) {
    return size_of(model) * length(model.scene.gravity_at(0.0)) * mass_of(model);
}

/// What the elements have more of where every coordinate is off by its own last bits [J], and what
/// motion that makes. Each coordinate for itself: a thin plate has large ones and small ones, and
/// only along the large ones is there much to lose.
double energy_of_rounding(const Model& model) {
    constexpr auto kStep = static_cast<float>(kRounding);
    const auto now = model.positions->span();
    std::vector<float4> off(now.begin(), now.end());
    double moment = 0.0;  // [kg m^2]
    for (std::size_t v = 0; v < off.size(); ++v) {
        const auto by = [&](std::size_t k) { return (v * 7919 + k) % 5 < 3 ? kStep : -kStep; };
        const float4& x = now[v];
        off[v] = {x.x + by(0) * x.x, x.y + by(1) * x.y, x.z + by(3) * x.z, x.w};
        if (x.w > 0.0f) moment += model.masses[v] * dot(to_vec3(x), to_vec3(x));
    }
    double sum = 0.0;
    for (const auto& family : model.families) {
        sum += std::abs(family->total_energy(off) - family->total_energy(now));
    }
    return sum + 0.5 * moment * (kRounding / model.h) * (kRounding / model.h);
}

bool is_visible(const Model& model, const Strain& strain) {
    const double visible = model.scene.cloths.empty() ? kVisibleStrainOfSolids : kVisibleStrain;
    return strain.rms > visible || strain.most > kTornStrain;
}

/// How much more strain than there was energy for is excused: in cloth infinitely much where it is
/// not to be seen, and less the plainer it is. Solids bend by the strain of their edges: a beam
/// sags plainly with hardly any, and there is no cloth that looks as it should all the same.
double most_strain(const Model& model, const Strain& strain) {
    if (model.scene.cloths.empty()) {
        return is_visible(model, strain) ? kMostMotion : kMostHiddenStrainOfSolids;
    }
    if (!is_visible(model, strain)) return std::numeric_limits<double>::infinity();
    return std::clamp(kMostStrain * kVisibleStrain / std::max(strain.rms, kVisibleStrain),
                      kMostMotion, kMostStrain);
}

}  // namespace

EnergyAccount::EnergyAccount(const Model& model, const Energies& start)
    : closed_(last_closing(model.scene)) {
    const double inside = energy_inside_obstacles(model);
    small_ = kSmallFall * lift_by_size(model) + inside;
    small_lift_ = kSmallLift * lift_by_size(model) + inside;
    last_.start = start.total();
    last_.energies = start;
    for (const auto& family : model.families) {
        for (int e = 0; e < family->count(); ++e) {
            if (family->tie(e)) ties_.push_back({&*family, e});
        }
    }
}

double EnergyAccount::energy_of_ties(const Model& model) const {
    double sum = 0.0;
    for (const auto& [family, element] : ties_) {
        sum +=
            family->energy(element, family->positions_of(element, model.positions->span()).data());
    }
    return sum;
}

EnergyAccount::Entry EnergyAccount::with_frame(double time, const OutsideWork& outside,
                                               const Energies& end, double found) const {
    if (time < closed_) return {end.total(), {}, end, false};
    Entry entry{last_.start + found, last_.outside, end, true};
    if (std::isinf(last_.outside.doubt) && std::isfinite(outside.doubt)) {
        entry.start = last_.energies.total() + found;
        entry.outside = {};
    }
    entry.outside.work += outside.work;
    entry.outside.doubt += outside.doubt;
    return entry;
}

std::optional<EnergyAlarm> EnergyAccount::look(const Entry& entry, const Strain& strain,
                                               const Model& model) const {
    if (!entry.is_known) return std::nullopt;
    const double outside = entry.outside.work + entry.outside.doubt;
    const double left = entry.start + outside - entry.energies.gravity;
    const double had = std::max(left, 0.0);
    const double lifted = std::max(-left, 0.0);
    const double motion = entry.energies.kinetic;
    const double strained = entry.energies.strain();
    const double pressed = entry.energies.contact.value_or(0.0);
    const double most = most_strain(model, strain);
    const auto is_fine = [&](double rounding) {
        const double enough = had + small_ + rounding;
        return lifted <= small_lift_ + rounding && motion <= kMostMotion * enough &&
               strained <= most * enough && pressed <= kMostInContacts * enough &&
               (strained <= kMostInTies * enough || energy_of_ties(model) <= kMostInTies * enough);
    };
    // What rounding gives takes a while to find out, and is hardly ever asked for.
    if (is_fine(0.0)) return std::nullopt;
    const double rounding = energy_of_rounding(model);
    if (is_fine(rounding)) return std::nullopt;
    const double enough = had + small_ + rounding;
    const bool explodes = motion > kExplodingMotion * enough ||
                          (strained > kExplodingStrain * enough && is_visible(model, strain));
    const std::string in_contacts =
        pressed > 0.0 ? fmt::format(", {:.3g} J of it in contacts", pressed) : "";
    const std::string there_was =
        lifted > 0.0
            ? fmt::format("and everything has been lifted by {:.3g} J more than there was", lifted)
            : fmt::format("where {:.3g} J were to be had", had);
    return EnergyAlarm{
        fmt::format("energy from nowhere: {:.3g} J of motion and {:.3g} J of strain{} (edges: "
                    "{:.3g} % RMS), {}",
                    motion, strained, in_contacts, 100.0 * strain.rms, there_was),
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
