#pragma once

#include <optional>

#include "simulation/checks/watch.h"
#include "simulation/contact/response.h"

namespace weft {

/// Says where contact has kept vertices from going with an obstacle that pushes them: what is too
/// fast for its substeps passes through cloth so.
class InsideChecks {
public:
    /// Of a frame; the host has the contact's insides and cuts.
    std::optional<Alarm> look(const Model& model, ContactResponse& contact);
    /// The last alarm was told, and the run goes on: only what is plainly deeper is another one.
    void told() { told_ = deepest_; }

private:
    double deepest_ = 0.0;  ///< [m] of the last alarm
    double told_ = 0.0;     ///< [m]
};

}  // namespace weft
