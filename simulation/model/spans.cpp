#include "simulation/model/spans.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace weft {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Ways along the ground: what hangs in a curve is between its ends as what is straight.
class Ground {
public:
    Ground(std::span<const Vec3> rest, std::span<const int> held, Vec3 down)
        : rest_(rest), held_(held), down_(down) {}

    /// Whether held vertices are all around the place, or nearly: what is held by one side hangs
    /// from that, even if a part of it lies between two corners.
    bool surrounds(Vec3 place) const {
        constexpr double kWidestGap = 200.0 * std::numbers::pi / 180.0;
        const Vec3 axis = std::abs(down_.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
        const Vec3 right = normalized(cross(down_, axis));
        const Vec3 ahead = cross(right, down_);
        std::vector<double> angles;
        for (const int v : held_) {
            const Vec3 there = way(place, v);
            angles.push_back(std::atan2(dot(there, ahead), dot(there, right)));
        }
        std::ranges::sort(angles);
        double widest = angles.front() + 2.0 * std::numbers::pi - angles.back();
        for (std::size_t i = 1; i < angles.size(); ++i) {
            widest = std::max(widest, angles[i] - angles[i - 1]);
        }
        return widest <= kWidestGap;
    }

    /// From the held vertex that is nearest to the place to the nearest one in line behind it. 0:
    /// there is none.
    Vec3 span_through(Vec3 place) const {
        constexpr double kInLine = 0.97;   // 166 degrees
        constexpr double kLopsided = 2.3;  // beyond that, the place is not in the middle
        const int first = nearest_to(place);
        const Vec3 near = way(place, first);
        const double distance = length(near);
        double least = kLopsided * distance;
        Vec3 span;
        for (const int v : held_) {
            const Vec3 far = way(place, v);
            const double own = length(far);
            if (own >= least || -dot(near, far) < kInLine * distance * own) continue;
            least = own;
            span = rest_[at(v)] - rest_[at(first)];
        }
        return span;
    }

private:
    Vec3 way(Vec3 place, int vertex) const {
        const Vec3 straight = rest_[at(vertex)] - place;
        return straight - dot(straight, down_) * down_;
    }
    int nearest_to(Vec3 place) const {
        return *std::ranges::min_element(held_, {}, [&](int v) {
            const Vec3 there = way(place, v);
            return dot(there, there);
        });
    }

    std::span<const Vec3> rest_;
    std::span<const int> held_;
    Vec3 down_;
};

struct Triangle {
    Vec3 a, b, c;
};

/// As long as its area is large.
Vec3 normal_of(const Triangle& t) { return 0.5 * cross(t.b - t.a, t.c - t.a); }

/// How a surface lies about a span.
class Lie {
public:
    Lie(Vec3 along, Vec3 down)
        : along_(along),
          down_(normalized(down - dot(down, along) * along)),
          aside_(cross(along, down_)) {}

    void add(const Triangle& t) {
        for (const Vec3 edge : {t.b - t.a, t.c - t.b, t.a - t.c}) {
            const double square = dot(edge, along_) * dot(edge, along_);
            squares_ += square;
            fourths_ += square * square;
        }
        const Vec3 area = normal_of(t);
        const double size = length(area);
        if (size == 0.0) return;
        const double down = dot(area, down_);
        const double aside = dot(area, aside_);
        difference_ += (down * down - aside * aside) / size;
        product_ += down * aside / size;
    }

    /// Of its edges, along the span [m]. Those across it do not count, long ones the most.
    double stride() const { return squares_ > 0.0 ? std::sqrt(fourths_ / squares_) : 0.0; }
    /// Across the span, and as far as can be across all triangles, whichever side they turn up.
    Vec3 normal() const {
        const double angle = 0.5 * std::atan2(2.0 * product_, difference_);
        return std::cos(angle) * down_ + std::sin(angle) * aside_;
    }

private:
    Vec3 along_, down_, aside_;
    double squares_ = 0.0, fourths_ = 0.0;
    double difference_ = 0.0, product_ = 0.0;
};

}  // namespace

/// The cloth on a path.
struct Spans::Cloth {
    std::vector<std::size_t> bodies;
    std::vector<int> held, loose;  ///< vertices; those that pins lead are neither
    double mass = 0.0;             ///< [kg]
    double area = 0.0;             ///< at rest [m^2]
    double load = 0.0;             ///< the mass of all bodies [kg]
};

Spans::Spans(const Gathered& all, Vec3 down)
    : all_(all), down_(down), moves_(all.rest.size(), 0), is_here_(moves_) {
    for (const MovingPins::Group& group : all.moving) {
        for (const int v : group.vertices) moves_[at(v)] = 1;
    }
}

Spans::Cloth Spans::cloth_of(std::span<const int> part,
                             const std::map<std::size_t, double>& masses) const {
    Cloth cloth;
    for (const auto& [number, mass] : masses) {
        cloth.load += mass;
        if (all_.bodies[number].kind != "cloth") continue;
        cloth.bodies.push_back(number);
        cloth.mass += mass;
        cloth.area += mass / all_.bearings[number].density;
    }
    for (const int v : part) {
        if (moves_[at(v)] != 0 || std::ranges::none_of(cloth.bodies, [&](std::size_t number) {
                return all_.bodies[number].has(SceneVertex{v});
            })) {
            continue;
        }
        (all_.held[at(v)] != 0 ? cloth.held : cloth.loose).push_back(v);
    }
    return cloth;
}

/// With those of the cloth on the part.
template <class Use>
void Spans::for_each_triangle(const Cloth& cloth, std::span<const int> part, const Use& use) {
    for (const int v : part) is_here_[at(v)] = 1;
    for (const std::size_t number : cloth.bodies) {
        const BodyRange& body = all_.bodies[number];
        for (int t = body.first_triangle; t < body.first_triangle + body.triangle_count; ++t) {
            const auto& [a, b, c] = all_.triangles[at(t)];
            if (is_here_[at(a)] == 0) continue;
            use(Triangle{all_.rest[at(a)], all_.rest[at(b)], all_.rest[at(c)]});
        }
    }
    for (const int v : part) is_here_[at(v)] = 0;
}

/// Of the whole cloth, to being stretched [J].
double Spans::resistance_of(const Cloth& cloth, Vec3 along) {
    if (resistance_.empty() || !(along == along_)) {
        along_ = along;
        resistance_.assign(all_.rest.size(), 0.0);
        for (const auto& family : all_.families) {
            family->add_resistance(all_.rest, along, resistance_);
        }
    }
    double sum = 0.0;
    for (const auto* vertices : {&cloth.held, &cloth.loose}) {
        for (const int v : *vertices) sum += resistance_[at(v)];
    }
    return sum;
}

void Spans::add_to(LoadPath& path, std::span<const int> part,
                   const std::map<std::size_t, double>& masses) {
    const Cloth cloth = cloth_of(part, masses);
    if (cloth.held.size() < 2 || cloth.loose.empty()) return;
    const Vec3 span = widest_span(all_.rest, cloth.held, cloth.loose, down_);
    const double width = length(span);
    if (width == 0.0 || length(cross(span, down_)) == 0.0) return;
    const Vec3 along = normalized(span);
    Lie lie(along, down_);
    for_each_triangle(cloth, part, [&](const Triangle& t) { lie.add(t); });
    const Vec3 normal = lie.normal();
    double seen = 0.0;
    for_each_triangle(cloth, part,
                      [&](const Triangle& t) { seen += std::abs(dot(normal_of(t), normal)); });
    if (seen == 0.0 || lie.stride() == 0.0) return;
    path.span = width;
    path.slack = cloth.area / seen - 1.0;
    path.pull = std::abs(dot(down_, normal)) * cloth.load / cloth.mass;
    path.stride = lie.stride();
    path.wave = std::sqrt(resistance_of(cloth, along) / cloth.mass);
}

Vec3 widest_span(std::span<const Vec3> rest, std::span<const int> held, std::span<const int> loose,
                 Vec3 down) {
    constexpr int kTried = 200;
    const Ground ground(rest, held, down);
    Vec3 middle;
    for (const int v : loose)
        middle = middle + 1.0 / static_cast<double>(loose.size()) * rest[at(v)];
    if (!ground.surrounds(middle)) return {};
    Vec3 widest;
    for (int i = 0; i < kTried; ++i) {
        // Spread over all of them, whatever their order.
        const double share = std::fmod((i + 0.5) * std::numbers::phi, 1.0);
        const auto chosen = static_cast<std::size_t>(share * static_cast<double>(loose.size()));
        const Vec3 span = ground.span_through(rest[at(loose[chosen])]);
        if (length(span) > length(widest)) widest = span;
    }
    return widest;
}

}  // namespace weft
