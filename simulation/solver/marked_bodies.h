#pragma once

#include <string_view>

#include "simulation/model/model.h"

namespace weft {

/// Sets the flags of all vertices of bodies of a kind to 1. flags: [vertices]
void mark_bodies(const Model& model, std::string_view kind, Buffer<float>& flags);

}  // namespace weft
