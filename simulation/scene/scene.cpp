#include "simulation/scene/scene.h"

#include <algorithm>

namespace weft {

Vec3 Scene::gravity_at(double time) const {
    if (gravity_keys.empty()) return gravity;
    const auto after = std::upper_bound(gravity_keys.begin(), gravity_keys.end(), time,
                                        [](double t, const GravityKey& k) { return t < k.time; });
    if (after == gravity_keys.begin()) return gravity_keys.front().gravity;
    if (after == gravity_keys.end()) return gravity_keys.back().gravity;
    const GravityKey& a = *(after - 1);
    const GravityKey& b = *after;
    return a.gravity + ((time - a.time) / (b.time - a.time)) * (b.gravity - a.gravity);
}

}  // namespace weft
