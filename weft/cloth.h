#pragma once

// Cloth and deformable solids (component `simulation`).
//
//   weft::ClothScene scene("tablecloth.toml", {.devices = "hybrid"});
//   for (int frame = 0; frame < 60; ++frame) {
//       if (frame == 30) scene.push(0, scene.vertex_count(), {0.0f, 2.0f, 0.0f});  // [m/s]
//       scene.step();
//       const std::vector<float> xyz = scene.positions();                          // [m]
//   }

#include "simulation/cloth_scene.h"
