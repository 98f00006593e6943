#pragma once

#include <vector>

#include "simulation/scene/document.h"
#include "simulation/scene/scene.h"

/// Attachments and seams out of a checked document. Throw UserError.
namespace weft {

/// scene: has its cloths and solids already.
std::vector<Attachment> read_attachments(const Node& root, const Scene& scene);
/// Into the scene's seams, and the welded ones into their cloths.
void read_seams(const Node& root, Scene& scene);

/// What says `weld` needs a shape that has several vertices in one place.
void require_weldable(const Node& table, const Shape& shape);

}  // namespace weft
