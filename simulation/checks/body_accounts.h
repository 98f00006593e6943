#pragma once

#include <optional>
#include <vector>

#include "simulation/checks/energy_account.h"

namespace weft {

/// The energy of each body by itself, where that is its own: a scene's bodies that neither touch
/// nor are tied to each other, and on which nothing works (pins and obstacles rest, gravity does
/// not change). What a body that falls sets free would hide what another one makes from nowhere
/// from the account of the whole scene (energy_account.h).
class BodyAccounts {
public:
    /// Of a body at one time.
    struct Energy {
        double kinetic = 0.0;    ///< [J]
        double potential = 0.0;  ///< [J]
        double strain = 0.0;     ///< [J]

        double total() const { return kinetic + potential + strain; }
    };

    /// They begin at the model's state. Of other scenes there are none.
    explicit BodyAccounts(const Model& model);

    /// [bodies] at the model's state, in every eighth frame, which is enough for what stays; or
    /// none. end: of the frame [s]
    std::vector<Energy> measure(const Model& model, double end) const;
    /// Whether one moves, or is higher, than its own energy allows. now: as measured
    std::optional<EnergyAlarm> look(const Model& model, const std::vector<Energy>& now) const;
    /// They begin anew: what was made from nowhere is now there to be had.
    void forgive(const std::vector<Energy>& now);

private:
    std::vector<Energy> measure(const Model& model) const;

    std::size_t body_count() const { return begins_.empty() ? 0 : begins_.size() - 1; }
    std::size_t body_of(int vertex) const;

    std::vector<int> begins_;    ///< [bodies + 1] their vertices, new order
    std::vector<double> start_;  ///< [bodies] [J]
    std::vector<double> lift_;   ///< [bodies] to lift it by its own size [J]; empty: no accounts
    double inside_ = 0.0;        ///< that what starts inside obstacles gets [J]
};

}  // namespace weft
