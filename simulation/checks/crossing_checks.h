#pragma once

#include <array>
#include <set>
#include <string>

#include "simulation/checks/contact_surface.h"

namespace weft {

/// Looks now and then, and at a run's end, whether surfaces cross that contact looks at, whatever
/// planes guarantee (docs/contact.md): what is led by the scene goes where it is led to.
class CrossingChecks {
public:
    /// At a run's start. may_cross: else nothing crosses there; which bodies do is not told again
    CrossingChecks(const Model& model, bool may_cross);

    /// Whether a frame's end is looked at: after 8, 16, 32, ... frames, and the scene's last one.
    bool wants(const Model& model, int frame) const;
    /// What crosses where the model is, once; else empty.
    std::string look(const Model& model);

private:
    std::array<int, 2> bodies(const TrianglePair& pair) const;

    ContactSurface surface_;
    std::set<std::array<int, 2>> known_;  ///< bodies that cross each other at the start
    bool is_told_ = false;
};

}  // namespace weft
