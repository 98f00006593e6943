#include "simulation/checks/body_starts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulation/families/convert.h"
#include "simulation/model/model.h"

namespace weft {

namespace {

constexpr int kMostVertices = 4000;  ///< of one body

constexpr std::size_t at(int vertex) { return static_cast<std::size_t>(vertex); }

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
double rms(const Model& model, const std::vector<int>& vertices, const PlaceOf& place_of) {
    if (vertices.empty()) return 0.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const Vec3 way = to_vec3((*model.positions)[at(vertices[i])]) - place_of(i);
        sum += dot(way, way);
    }
    return std::sqrt(sum / static_cast<double>(vertices.size()));
}

/// Likewise.
template <class PlaceOf>
Vec3 mean(const Model& model, const std::vector<int>& vertices, const PlaceOf& place_of) {
    Vec3 sum;
    if (vertices.empty()) return sum;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        sum = sum + (to_vec3((*model.positions)[at(vertices[i])]) - place_of(i));
    }
    return (1.0 / static_cast<double>(vertices.size())) * sum;
}

/// Of places in scene order.
auto placed_at(const Model& model, const std::vector<int>& vertices, std::span<const float> xyz) {
    return [&model, &vertices, xyz](std::size_t i) {
        const std::size_t v = index(model.scene_vertex(vertices[i]));
        return Vec3{xyz[3 * v], xyz[3 * v + 1], xyz[3 * v + 2]};
    };
}

auto started_at(const std::vector<float4>& places) {
    return [&places](std::size_t i) { return to_vec3(places[i]); };
}

}  // namespace

BodyStarts::BodyStarts(const Model& model) {
    Box all;
    for (const BodyRange& range : model.bodies) {
        Body body;
        Box box;
        const int stride = 1 + range.vertex_count / kMostVertices;
        for (int own = 0; own < range.vertex_count; ++own) {
            const int v = model.vertex(range.vertex(own));
            const float4& x = (*model.positions)[at(v)];
            box.add(to_vec3(x));
            all.add(to_vec3(x));
            if (x.w <= 0.0f) continue;
            body.mass += model.masses[at(v)];
            if (own % stride != 0) continue;
            body.vertices.push_back(v);
            body.places.push_back(x);
        }
        body.size = box.diagonal();
        bodies_.push_back(std::move(body));
    }
    size_ = all.diagonal();
}

double BodyStarts::rms_way(const Model& model, std::size_t body) const {
    const Body& b = bodies_[body];
    return rms(model, b.vertices, started_at(b.places));
}

double BodyStarts::rms_way(const Model& model, std::size_t body,
                           std::span<const float> from) const {
    const Body& b = bodies_[body];
    return rms(model, b.vertices, placed_at(model, b.vertices, from));
}

Vec3 BodyStarts::mean_way(const Model& model, std::size_t body) const {
    const Body& b = bodies_[body];
    return mean(model, b.vertices, started_at(b.places));
}

Vec3 BodyStarts::mean_way(const Model& model, std::size_t body, std::span<const float> from) const {
    const Body& b = bodies_[body];
    return mean(model, b.vertices, placed_at(model, b.vertices, from));
}

}  // namespace weft
