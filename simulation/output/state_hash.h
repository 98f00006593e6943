#pragma once

#include <array>
#include <span>
#include <string>

#include "runtime/buffer.h"

namespace weft {

/// 128-bit hash of a state, as 32 hex digits: equal states of any two machines, devices or plans
/// have equal hashes, and one different bit makes another hash. It is no defence against forgery.
///
/// positions, velocities  [3 * vertices] float32 in the scene's own vertex order. What counts is
/// the bits: -0.0 and 0.0 differ.
///
/// Definition: the hash of word_hash.h over the words (uint32) of the vertex count, all positions,
/// all velocities and, where it is not 0, the origin's float64, each one's low word first.
std::string state_hash(std::span<const float> positions, std::span<const float> velocities);

/// The same of xyz in other orders. rows: [vertices] which row each vertex of the scene has.
/// origin: that positions count from [m]
std::string state_hash(std::span<const int> rows, std::span<const float4> positions,
                       std::span<const float4> velocities,
                       const std::array<double, 3>& origin = {});

}  // namespace weft
