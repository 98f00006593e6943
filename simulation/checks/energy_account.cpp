#include "simulation/checks/energy_account.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "simulation/checks/energy_limits.h"
#include "simulation/checks/start_checks.h"
#include "simulation/families/tetrahedra/tetrahedra.h"

namespace weft {

namespace {

// Sweeps of few iterations, in scenes that look as they should, have strain of a few times the
// energy that it should have while edges are hardly longer. Where edges are far longer, nothing
// looks as it should, and strain has no more excuse than motion.
constexpr double kMostHiddenStrain = 50.0;
constexpr double kMostStrain = 10.0;
constexpr double kVisibleStrain = 0.05;  ///< of edges, RMS
constexpr double kVisibleStrainOfSolids = 0.02;
constexpr double kMostHiddenStrainOfSolids = 4.0;
constexpr double kTornStrain = 1.0;  ///< of one edge
// What contacts have stored is seen as little in edges as it has to do with them.
constexpr double kMostInContacts = 2.0;
constexpr double kMostInTies = 10.0;  ///< likewise
// What strain gives back is motion. Of that, this much of the most that there was to be had may be
// from nowhere.
constexpr double kMostGainedInMotion = 0.1;
// And what no such sweep does.
constexpr double kExplodingStrain = 1000.0;

double last_closing(const Scene& scene) {
    double last = 0.0;
    for (const Seam& seam : scene.seams) last = std::max(last, seam.time);
    return last;
}

bool is_visible(const Model& model, const Strain& strain) {
    const double visible = model.scene.cloths.empty() ? kVisibleStrainOfSolids : kVisibleStrain;
    return strain.rms > visible || strain.most > kTornStrain;
}

/// How much more strain than there was energy for is excused: in cloth less the plainer it is.
/// Solids bend by the strain of their edges: a beam sags plainly with hardly any, and there is no
/// cloth that looks as it should all the same.
double most_strain(const Model& model, const Strain& strain) {
    if (model.scene.cloths.empty()) {
        return is_visible(model, strain) ? kMostMotion : kMostHiddenStrainOfSolids;
    }
    if (!is_visible(model, strain)) return kMostHiddenStrain;
    return std::clamp(kMostStrain * kVisibleStrain / std::max(strain.rms, kVisibleStrain),
                      kMostMotion, kMostStrain);
}

/// [J] of which cloth beside them is no excuse.
double energy_of_solids(const Model& model, const Energies& energies) {
    double sum = 0.0;
    for (std::size_t f = 0; f < model.families.size(); ++f) {
        if (dynamic_cast<const Tetrahedra*>(&*model.families[f])) sum += energies.elements[f];
    }
    return sum;
}

}  // namespace

EnergyAccount::EnergyAccount(const Model& model, const Energies& start)
    : closed_(last_closing(model.scene)) {
    const double inside = energy_inside_obstacles(model);
    const double lift = lift_by_size(model, 0, model.vertex_count());
    small_ = kSmallFall * lift + inside;
    small_lift_ = kSmallLift * lift + inside;
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
    Entry entry = last_;
    entry.start += found;
    entry.energies = end;
    entry.is_known = true;
    if (std::isinf(last_.outside.doubt) && std::isfinite(outside.doubt)) {
        entry.start = last_.energies.total() + found;
        entry.outside = {};
        entry.most_dissipated = entry.lost_at_once = entry.forgiven = entry.most_had = 0.0;
    }
    entry.outside.work += outside.work;
    entry.outside.doubt += outside.doubt;
    const double lost = entry.dissipated() - entry.most_dissipated;
    entry.lost_at_once += std::clamp(lost, 0.0, std::max(found, 0.0));
    entry.most_dissipated = std::max(entry.most_dissipated, entry.dissipated());
    entry.most_had = std::max(entry.most_had, entry.left());
    return entry;
}

double EnergyAccount::Entry::gained() const {
    if (!is_known || std::isinf(outside.doubt)) return std::numeric_limits<double>::quiet_NaN();
    return std::max(most_dissipated - dissipated() - outside.doubt, 0.0);
}

double EnergyAccount::Entry::gained_in_motion() const {
    return gained() - energies.strain() - energies.contact.value_or(0.0);
}

double EnergyAccount::Entry::left() const {
    return start - lost_at_once + outside.work + outside.doubt - energies.gravity;
}

std::optional<EnergyAlarm> EnergyAccount::look(const Entry& entry, const Strain& strain,
                                               const Model& model) const {
    if (!entry.is_known) return std::nullopt;
    const double left = entry.left();
    const double had = std::max(left, 0.0);
    const double lifted = std::max(-left, 0.0);
    const double motion = entry.energies.kinetic;
    const double strained = entry.energies.strain();
    const double pressed = entry.energies.contact.value_or(0.0);
    const double most = most_strain(model, strain);
    const double in_solids = energy_of_solids(model, entry.energies);
    const double gained = entry.gained_in_motion();
    const double most_gained = kMostGainedInMotion * entry.most_had + small_;
    const auto is_fine = [&](double rounding) {
        const double enough = had + small_ + rounding;
        return lifted <= small_lift_ + rounding && !(gained > most_gained + rounding) &&
               motion <= kMostMotion * enough && strained <= most * enough &&
               in_solids <= kMostHiddenStrainOfSolids * enough &&
               pressed <= kMostInContacts * enough &&
               (strained <= kMostInTies * enough || energy_of_ties(model) <= kMostInTies * enough);
    };
    const auto explodes = [&](double rounding) {
        const double enough = std::max(left - entry.forgiven, 0.0) + small_ + rounding;
        return motion > kExplodingMotion * enough ||
               (strained > kExplodingStrain * enough && is_visible(model, strain));
    };
    const auto nothing_is_wrong = [&](double rounding) {
        return is_fine(rounding) && !explodes(rounding);
    };
    // What rounding gives takes a while to find out, and is hardly ever asked for.
    if (nothing_is_wrong(0.0)) return std::nullopt;
    const double rounding = energy_of_rounding(model);
    if (nothing_is_wrong(rounding)) return std::nullopt;
    const std::string in_contacts =
        pressed > 0.0 ? fmt::format(", {:.3g} J of it in contacts", pressed) : "";
    const std::string comes_back =
        gained > most_gained + rounding
            ? fmt::format(", and {:.3g} J of motion or height are again there that were gone",
                          gained)
            : "";
    return EnergyAlarm{
        fmt::format("energy from nowhere: {:.3g} J of motion and {:.3g} J of strain{} (edges: "
                    "{:.3g} % RMS), {}{}",
                    motion, strained, in_contacts, 100.0 * strain.rms, there_was(had, lifted),
                    comes_back),
        explodes(rounding)};
}

void EnergyAccount::forgive(bool is_explosion) {
    const double made = std::max(last_.lost_at_once - last_.dissipated(), 0.0);
    last_.forgiven = is_explosion ? 0.0 : last_.forgiven + made;
    last_.start = last_.energies.total();
    last_.outside = {};
    last_.most_dissipated = last_.lost_at_once = last_.most_had = 0.0;
}

std::array<double, 8> EnergyAccount::save() const {
    return {last_.start,           last_.outside.work,
            last_.outside.doubt,   last_.energies.contact.value_or(0.0),
            last_.most_dissipated, last_.lost_at_once,
            last_.forgiven,        last_.most_had};
}

void EnergyAccount::restore(const std::array<double, 8>& saved, Energies now) {
    if (now.contact) now.contact = saved[3];
    last_ = {saved[0], {saved[1], saved[2]}, std::move(now), true, saved[4], saved[5], saved[6],
             saved[7]};
}

}  // namespace weft
