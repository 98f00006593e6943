#include "simulation/scene/obstacle_shapes.h"

#include <algorithm>
#include <cmath>

#include "simulation/scene/node_values.h"

namespace weft {
namespace {

const Range kLength = positive_up_to(1e6);

Key point(std::string name, std::string help) {
    return {.name = std::move(name),
            .forms = {{3}},
            .help = std::move(help),
            .unit = "m",
            .required = true};
}

Key radius() {
    return {.name = "radius", .help = "radius", .unit = "m", .required = true, .range = kLength};
}

/// Any right-handed axes whose second (local y) is `up`.
Mat3 axes_with_up(Vec3 up) {
    const Vec3 y = normalized(up);
    const Vec3 away = std::abs(y.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 0, 1};
    const Vec3 z = normalized(cross(away, y));
    return transposed(Mat3{{cross(y, z), y, z}});
}

void read_sphere(const Node& table, Obstacle& obstacle) {
    obstacle.frame.origin = vec3_value(table, "center");
    const double radius = number_value(table, "radius");
    obstacle.dimensions = {radius};
    obstacle.half_width = radius;
    obstacle.half_size = {radius, radius, radius};
}

void read_plane(const Node& table, Obstacle& obstacle) {
    obstacle.frame.origin = vec3_value(table, "point");
    obstacle.frame.axes = axes_with_up(direction_value(table, "normal"));
}

void read_capsule(const Node& table, Obstacle& obstacle) {
    const Vec3 start = vec3_value(table, "start");
    const Vec3 along = vec3_value(table, "end") - start;
    if (length(along) < 1e-9) {
        throw value_error(table, "end", "must not be the same point as 'start'; use a sphere");
    }
    obstacle.frame.origin = start + 0.5 * along;
    obstacle.frame.axes = axes_with_up(along);
    const double radius = number_value(table, "radius");
    obstacle.dimensions = {radius, 0.5 * length(along)};
    obstacle.half_width = radius;
    obstacle.half_size = {radius, radius + 0.5 * length(along), radius};
}

void read_box(const Node& table, Obstacle& obstacle) {
    const Vec3 size = vec3_value(table, "size");
    obstacle.frame.origin = vec3_value(table, "center");
    for (const Rotation& rotation : rotation_values(table, "rotate")) {
        obstacle.frame.axes =
            rotation_matrix(rotation.axis, rotation.degrees) * obstacle.frame.axes;
    }
    obstacle.half_size = 0.5 * size;
    obstacle.half_width = 0.5 * std::min({size.x, size.y, size.z});
    obstacle.dimensions = {0.5 * size.x, 0.5 * size.y, 0.5 * size.z};
}

}  // namespace

const std::vector<ObstacleShape>& obstacle_shapes() {
    static const std::vector<ObstacleShape> shapes{
        {"sphere", {point("center", "centre"), radius()}, read_sphere},
        {"plane",
         {point("point", "any point of the plane"),
          {.name = "normal",
           .forms = {{3}},
           .help = "away from the solid side; any length",
           .fallback = std::vector<double>{0, 1, 0}}},
         read_plane},
        {"capsule",
         {point("start", "one end of the axis"), point("end", "the other end"), radius()},
         read_capsule},
        {"box",
         {point("center", "centre"),
          {.name = "size",
           .forms = {{3}},
           .help = "full widths along its own axes",
           .unit = "m",
           .required = true,
           .range = kLength},
          rotation_key()},
         read_box},
    };
    return shapes;
}

}  // namespace weft
