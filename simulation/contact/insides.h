#pragma once

#include <vector>

#include "runtime/launch.h"
#include "runtime/step.h"
#include "simulation/model/model.h"

namespace weft {

/// What contact leaves inside convex obstacles: they push vertices, and contact, which has the last
/// word, takes some of them back (kernels/obstacles/inside.h).
class Insides {
public:
    /// Of a model that has such obstacles.
    explicit Insides(Model& model);

    /// At a substep's end. cut: [vertices] whom the last truncation took back
    void add_launch(std::vector<Launch>& launches, Buffer<int>& cut);
    void add_accesses(Step::Adding& task, int first, int last);

    // Of the frame:
    /// [vertices] how far each has been inside of one or behind it [m];
    Buffer<float>& depths() { return depths_; }
    /// [vertices] of which, in Model::convex_obstacles.
    Buffer<int>& obstacles() { return obstacles_; }

private:
    Model& model_;
    Buffer<float> depths_;
    Buffer<int> obstacles_;
};

}  // namespace weft
