#pragma once

#include <optional>
#include <string_view>

#include "simulation/scene/document.h"
#include "simulation/scene/motion.h"

namespace weft {

/// Throws UserError about `key` unless `time` comes after `before` [s].
void require_rising(const Node& table, std::string_view key, double before, double time);

/// The motion of an obstacle or of pins; nothing where there is none, or one at rest.
/// center  what it turns about unless it says otherwise
std::optional<Motion> read_motion(const Node& owner, Vec3 center);

}  // namespace weft
