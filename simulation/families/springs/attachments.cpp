#include "simulation/families/springs/attachments.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "runtime/error.h"
#include "simulation/bodies/body_range.h"
#include "simulation/bodies/selection.h"

namespace weft {

namespace {

const BodyRange& body_named(std::span<const BodyRange> bodies, const std::string& name) {
    return *std::find_if(bodies.begin(), bodies.end(),
                         [&](const BodyRange& body) { return body.name == name; });
}

const Shape& shape_of(const Scene& scene, const std::string& body) {
    for (const Cloth& cloth : scene.cloths) {
        if (cloth.name == body) return cloth.shape;
    }
    return std::find_if(scene.solids.begin(), scene.solids.end(),
                        [&](const Solid& solid) { return solid.name == body; })
        ->shape;
}

/// Finds nearest points by a search along x, which ends where x alone is further away.
class NearestPoint {
public:
    explicit NearestPoint(std::span<const Vec3> points) : points_(points), by_x_(points.size()) {
        std::iota(by_x_.begin(), by_x_.end(), 0);
        std::sort(by_x_.begin(), by_x_.end(),
                  [&](int a, int b) { return std::pair(at(a).x, a) < std::pair(at(b).x, b); });
    }

    /// Of points at the same distance, the first one.
    std::pair<int, double> find(Vec3 p) const {
        std::pair<double, int> best{std::numeric_limits<double>::infinity(), -1};
        const auto is_too_far = [&](int candidate) {
            if (std::abs(at(candidate).x - p.x) > best.first) return true;
            best = std::min(best, {length(at(candidate) - p), candidate});
            return false;
        };
        const auto start = std::lower_bound(by_x_.begin(), by_x_.end(), p.x,
                                            [&](int a, double x) { return at(a).x < x; });
        std::find_if(start, by_x_.end(), is_too_far);
        std::find_if(std::make_reverse_iterator(start), by_x_.rend(), is_too_far);
        return {best.second, best.first};
    }

private:
    Vec3 at(int point) const { return points_[static_cast<std::size_t>(point)]; }

    std::span<const Vec3> points_;
    std::vector<int> by_x_;
};

std::span<const Vec3> points_of(const BodyRange& body, std::span<const Vec3> rest) {
    return rest.subspan(static_cast<std::size_t>(body.first_vertex),
                        static_cast<std::size_t>(body.vertex_count));
}

}  // namespace

std::vector<std::array<int, 2>> find_ties(const Attachment& attachment, const Scene& scene,
                                          std::span<const BodyRange> bodies,
                                          std::span<const Vec3> rest) {
    const BodyRange& a = body_named(bodies, attachment.a);
    const BodyRange& b = body_named(bodies, attachment.b);
    const std::span<const Vec3> from = points_of(a, rest);
    const NearestPoint nearest(points_of(b, rest));
    const double reach = attachment.reach.value_or(std::numeric_limits<double>::infinity());

    std::vector<std::array<int, 2>> ties;
    double least = std::numeric_limits<double>::infinity();
    for (const int vertex :
         selected_vertices(attachment.selected, shape_of(scene, attachment.a), from, a.parts,
                           fmt::format("attachment of {} '{}'", a.kind, a.name), a.welded)) {
        const auto [other, distance] = nearest.find(from[static_cast<std::size_t>(vertex)]);
        least = std::min(least, distance);
        if (distance <= reach) ties.push_back({a.first_vertex + vertex, b.first_vertex + other});
    }
    if (!ties.empty()) return ties;
    throw UserError(
        fmt::format("{}: attachment of {} '{}' to {} '{}': no selected vertex is within "
                    "reach = {} m; the nearest is {:g} m away",
                    attachment.where, a.kind, a.name, b.kind, b.name, reach, least));
}

}  // namespace weft
