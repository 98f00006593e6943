#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "simulation/checks/outside_work.h"
#include "simulation/state/diagnostics.h"

namespace weft {

/// What speaks against a state that is finite and within the scene's [guard].
struct EnergyAlarm {
    std::string what;
    bool is_explosion = false;  ///< no longer a matter of steps that are solved a little short
};

/// Where the energy of a run comes from. At any time
///
///     kinetic + potential + dissipated = the start's energy + work from outside,
///
/// and what is dissipated is not negative. Steps that are not solved far enough may make energy
/// from nowhere, with every number finite; this finds it, in the frame in which it happens.
class EnergyAccount {
public:
    /// The account at a frame's end.
    struct Entry {
        double start = 0.0;  ///< energy that the account began with [J]
        OutsideWork outside;
        Energies energies;
        bool is_known = true;          ///< false: something works of which nothing is known
        double most_dissipated = 0.0;  ///< [J] that was so far
        double lost_at_once = 0.0;     ///< [J] of what was found, by the frame that found it
        double forgiven = 0.0;         ///< [J] that came from nowhere, and counts as had since
        double most_had = 0.0;         ///< [J] that could be in motion and strain so far

        double dissipated() const { return start + outside.work - energies.total(); }
        /// What has come from nowhere [J]: nothing that is dissipated comes back. NaN: not known
        double gained() const;
        /// What of it is in motion or height, even if all strain is from nowhere [J].
        double gained_in_motion() const;
        /// What can be in motion and strain, at this height [J]; negative where it is too high.
        double left() const;
    };

    /// start: of the state that the run begins with
    EnergyAccount(const Model& model, const Energies& start);

    const Entry& last() const { return last_; }
    /// With one more frame, that begins at `time`. found: energy that was there to be had without
    /// being known of [J]; what of it the frame loses is there no more
    Entry with_frame(double time, const OutsideWork& outside, const Energies& end,
                     double found = 0.0) const;
    /// Whether there is energy from nowhere in it; the model is at the entry's state.
    std::optional<EnergyAlarm> look(const Entry& entry, const Strain& strain,
                                    const Model& model) const;
    void accept(Entry entry) { last_ = std::move(entry); }
    /// Begins anew: what was made from nowhere is now there to be had. After a doubt it is so for
    /// doubts alone: what creeps up from one to the next explodes in the end.
    void forgive(bool is_explosion);

    /// The numbers that it carries, for checkpoints.
    std::array<double, 8> save() const;
    /// now: of the state, without what contacts have stored
    void restore(const std::array<double, 8>& saved, Energies now);

private:
    double closed_;  ///< [s] when the last seam is: until then the ends of frames tell too little
    /// An element that is one.
    struct TieElement {
        const ElementFamily* family;
        int element;
    };
    double energy_of_ties(const Model& model) const;

    std::vector<TieElement> ties_;
    double small_ = 0.0;  ///< [J] that a little fall gives, and what starts inside obstacles gets
    double small_lift_ = 0.0;  ///< [J] that lifts everything by even less, and again these
    Entry last_;
};

}  // namespace weft
