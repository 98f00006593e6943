#pragma once

#include "simulation/scene/document.h"
#include "simulation/scene/scene.h"

/// Which vertices of a body are meant, out of a checked document.
namespace weft {

inline constexpr const char* kSelectionKeys = "corners, edges, rims, faces, parts, vertices or box";

/// Whether the table says it, also by a list that is empty: a sweep may have nothing selected in
/// one of its runs.
bool has_selection(const Node& table);
/// Of a body with that shape. Throws UserError.
void read_selection(const Node& table, const Shape& shape, Selection& selection);
bool names_any(const Selection& selection);

}  // namespace weft
