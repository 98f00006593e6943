#include "simulation/unsolved_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulation/families/convert.h"
#include "simulation/model/model.h"

namespace weft {

namespace {

// Measured on 80 scenes by five solvers, compared with runs of a quarter of the step. Where bodies
// only sagged, solved steps took back 0.2 to 0.8 of the way; where they moved much as they should,
// 0.04 at most.
constexpr double kPart = 0.15;
constexpr double kVisible = 5e-4;  ///< of a body's size
// Where strain made the motion, moved^2 / (e L^2) was 0.02 to 0.3, with two thirds of the strain
// undone; elsewhere 1 and more.
constexpr double kHanging = 0.375;
constexpr double kReturned = 0.25;  ///< of the farthest way: what has come back says nothing
constexpr double kVisibleStrain = 1e-3;
constexpr double kPartOfStrain = 0.5;

Vec3 place(std::span<const float> xyz, std::size_t v) {
    return {xyz[3 * v], xyz[3 * v + 1], xyz[3 * v + 2]};
}

/// Grows around points.
struct Box {
    Vec3 low{kNone, kNone, kNone}, high{-kNone, -kNone, -kNone};

    void add(Vec3 x) {
        low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
        high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
    }
    double diagonal() const { return low.x <= high.x ? length(high - low) : 0.0; }

    static constexpr double kNone = std::numeric_limits<double>::max();
};

/// To where the vertices are from where they were [m].
template <class PlaceOf>
double rms_way(const Model& model, const std::vector<int>& vertices, const PlaceOf& place_of) {
    if (vertices.empty()) return 0.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const Vec3 now = to_vec3((*model.positions)[static_cast<std::size_t>(vertices[i])]);
        const Vec3 way = now - place_of(i);
        sum += dot(way, way);
    }
    return std::sqrt(sum / static_cast<double>(vertices.size()));
}

/// A mean way does not take all vertices of a large body to know.
constexpr int kMostVertices = 4000;

}  // namespace

UnsolvedMotion::UnsolvedMotion(const Model& model) {
    Box all;
    for (const BodyRange& body : model.bodies) {
        Start start;
        Box box;
        const int stride = 1 + body.vertex_count / kMostVertices;
        for (int own = 0; own < body.vertex_count; ++own) {
            const int v = model.vertex(body.vertex(own));
            const float4& x = (*model.positions)[static_cast<std::size_t>(v)];
            box.add(to_vec3(x));
            all.add(to_vec3(x));
            if (x.w <= 0.0f) continue;
            start.mass += model.masses[static_cast<std::size_t>(v)];
            if (own % stride != 0) continue;
            start.vertices.push_back(v);
            start.places.push_back(x);
        }
        start.size = box.diagonal();
        starts_.push_back(std::move(start));
    }
    size_ = all.diagonal();
    most_.bodies.resize(starts_.size());
}

UnsolvedMotion::Moved UnsolvedMotion::moved(const Model& model) const {
    Moved now;
    double mass = 0.0;
    double sum = 0.0;
    for (const Start& start : starts_) {
        const double way =
            rms_way(model, start.vertices, [&](std::size_t i) { return to_vec3(start.places[i]); });
        now.bodies.push_back(way);
        mass += start.mass;
        sum += start.mass * way * way;
    }
    if (mass > 0.0) now.all = std::sqrt(sum / mass);
    return now;
}

void UnsolvedMotion::note(const Model& model) {
    const Moved now = moved(model);
    most_.all = std::max(most_.all, now.all);
    for (std::size_t b = 0; b < starts_.size(); ++b) {
        most_.bodies[b] = std::max(most_.bodies[b], now.bodies[b]);
    }
}

std::optional<UnsolvedMotion::Found> UnsolvedMotion::find(const Model& model,
                                                          std::span<const float> solved) const {
    const Moved now = moved(model);
    std::optional<Found> worst;
    for (std::size_t b = 0; b < starts_.size(); ++b) {
        const Start& start = starts_[b];
        const double way = std::max(most_.bodies[b], now.bodies[b]);
        const double undone = rms_way(model, start.vertices, [&](std::size_t i) {
            return place(solved, index(model.scene_vertex(start.vertices[i])));
        });
        if (undone <= kPart * way || undone <= kVisible * start.size) continue;
        if (!worst || undone * worst->moved > worst->undone * way) worst = {b, way, undone};
    }
    return worst;
}

std::optional<double> UnsolvedMotion::find(const Model& model, double strain, double solved) const {
    const double undone = std::sqrt(std::max(strain * strain - solved * solved, 0.0));
    if (undone < kVisibleStrain || undone < kPartOfStrain * strain) return std::nullopt;
    const double now = moved(model).all;
    const double way = std::max(now, kReturned * most_.all);
    if (way * way >= kHanging * undone * size_ * size_) return std::nullopt;
    return now;
}

}  // namespace weft
