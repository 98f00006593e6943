#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/tbb/parallel.h"
#include "simulation/checks/body_accounts.h"
#include "simulation/checks/energy_account.h"
#include "simulation/contact/energy.h"
#include "simulation/state/simulation_state.h"

namespace weft {

/// What speaks against a state.
struct Alarm {
    enum class Kind {
        kNoState,    ///< not finite: nothing can go on from here
        kExplosion,  ///< beyond the scene's [guard], or energy that cannot be
        kDoubt,      ///< energy from nowhere, as steps give that are solved too little
    };
    Kind kind;
    std::string what;
    std::optional<int> vertex;  ///< new order
    std::string remedy = {};    ///< of a doubt; empty: steps that are solved farther
};

/// Looks at every state between two frames: whether it is one, how far its edges are strained, and
/// where its energy comes from.
class Watch {
public:
    struct Look {
        Strain strain;
        EnergyAccount::Entry entry;
        std::vector<BodyAccounts::Energy> bodies;  ///< where they are looked at
        std::optional<Alarm> alarm;
    };

    /// keeps_account: false: only whether a state is one. threads: to do it with
    Watch(const Model& model, bool keeps_account, int threads);

    /// At the model's state, at `end` [s]; its frame began at `start`, with `before`. contacts:
    /// what they had stored at both
    Look look(const Model& model, const SimulationState& before, double start, double end,
              const StoredInContacts& contacts) const;
    /// Goes on from a state that was looked at. forgives: what came from nowhere is there now
    void accept(const Look& look, bool forgives);
    const EnergyAccount& account() const { return account_; }

    /// Goes on from another state, at a time [s], as its run's account stood there (none: anew).
    void restart(const Model& model, double time,
                 const std::optional<std::array<double, 8>>& saved = std::nullopt);
    /// The next frame's contacts store more or less than those of the last one, in the same state.
    void expect_other_contacts() { knows_contacts_ = false; }

private:
    Look look_here(const Model& model, const SimulationState& before, double start, double end,
                   const StoredInContacts& contacts) const;
    double found(const StoredInContacts& contacts) const;

    HostThreads threads_;
    bool keeps_account_;
    EnergyAccount account_;
    BodyAccounts bodies_;
    bool knows_contacts_ = false;  ///< what they have stored in the last state
};

}  // namespace weft
