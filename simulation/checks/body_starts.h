#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kernels/platform.h"
#include "simulation/mesh/vec3.h"

namespace weft {

class Model;

/// Where bodies started, and how far they have gone. All goes by some of a body's vertices that
/// move freely: a mean does not take all of a large one's to know.
class BodyStarts {
public:
    /// Where everything is now.
    explicit BodyStarts(const Model& model);

    std::size_t count() const { return bodies_.size(); }
    /// Of everything: the diagonal of the box around it [m].
    double size() const { return size_; }
    double size(std::size_t body) const { return bodies_[body].size; }  ///< likewise
    /// Of all that moves freely [kg].
    double mass(std::size_t body) const { return bodies_[body].mass; }

    /// To where the body is, RMS [m]: from its start, or from other places, xyz in scene order.
    double rms_way(const Model& model, std::size_t body) const;
    double rms_way(const Model& model, std::size_t body, std::span<const float> from) const;
    /// Likewise of its middle.
    Vec3 mean_way(const Model& model, std::size_t body) const;
    Vec3 mean_way(const Model& model, std::size_t body, std::span<const float> from) const;

private:
    struct Body {
        std::vector<float4> places;
        std::vector<int> vertices;
        double mass = 0.0, size = 0.0;
    };

    std::vector<Body> bodies_;  ///< as the model has them
    double size_ = 0.0;
};

}  // namespace weft
