#include "simulation/mesh/vec3.h"

#include <numbers>

namespace weft {

Mat3 rotation_matrix(Vec3 axis, double degrees) {
    const Vec3 n = normalized(axis);
    const double angle = degrees * (std::numbers::pi / 180.0);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double t = 1.0 - c;
    return {{Vec3{t * n.x * n.x + c, t * n.x * n.y - s * n.z, t * n.x * n.z + s * n.y},
             Vec3{t * n.x * n.y + s * n.z, t * n.y * n.y + c, t * n.y * n.z - s * n.x},
             Vec3{t * n.x * n.z - s * n.y, t * n.y * n.z + s * n.x, t * n.z * n.z + c}}};
}

}  // namespace weft
