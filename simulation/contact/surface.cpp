#include "simulation/contact/surface.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <tuple>

#include "simulation/contact/notches.h"
#include "simulation/contact/patch_groups.h"

namespace weft {

namespace {

using Triangle = std::array<int, 3>;

double along(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

int widest_axis(std::span<const int> vertices, const std::vector<Vec3>& rest) {
    int widest = 0;
    double most = -1.0;
    for (int axis = 0; axis < 3; ++axis) {
        const auto at = [&](int v) { return along(rest[static_cast<std::size_t>(v)], axis); };
        const auto [low, high] = std::ranges::minmax(vertices, {}, at);
        if (at(high) - at(low) > most) std::tie(widest, most) = std::pair(axis, at(high) - at(low));
    }
    return widest;
}

/// Vertices of the first half: whole patches, groups of 8 patches or of 64, as large as there are
/// several of, so that the boxes around 8 and 64 patches are compact, too.
int first_half(int count) {
    int unit = Surface::kPatchVertices;
    while (unit < 64 * Surface::kPatchVertices && 8 * unit < count) unit *= 8;
    return std::max(unit, (count / 2 + unit / 2) / unit * unit);
}

/// Puts them into the order of patches: cut in half along the widest axis, down to two vertices, so
/// that packs of what is in a patch are compact, too.
void bisect(std::span<int> vertices, const std::vector<Vec3>& rest) {
    const int count = static_cast<int>(vertices.size());
    if (count <= 2) {
        std::ranges::sort(vertices);
        return;
    }
    const int axis = widest_axis(vertices, rest);
    const int half = count <= Surface::kPatchVertices ? count / 2 : first_half(count);
    std::ranges::nth_element(vertices, vertices.begin() + half, {}, [&](int v) {
        return std::pair(along(rest[static_cast<std::size_t>(v)], axis), v);
    });
    bisect(vertices.first(static_cast<std::size_t>(half)), rest);
    bisect(vertices.subspan(static_cast<std::size_t>(half)), rest);
}

/// A list more: the items, each once, ascending.
void add_set(Lists& lists, std::vector<int> items) {
    std::ranges::sort(items);
    items.erase(std::ranges::unique(items).begin(), items.end());
    lists.items.insert(lists.items.end(), items.begin(), items.end());
    lists.close();
}

class Builder {
public:
    Builder(const SurfaceMesh& mesh, const Strips& strips)
        : mesh_(mesh),
          strips_(strips),
          number_(mesh.rest.size(), -1),
          body_(mesh.rest.size(), -1) {}

    Surface build() {
        gather_triangles();
        make_patches();
        place_triangles();
        place_edges();
        find_incidence();
        find_shared_features();
        find_faces();
        find_rims();
        find_hulls();
        find_patches_at();
        add_turns();
        find_beside();
        mark_held();
        return std::move(s_);
    }

private:
    void gather_triangles() {
        for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
            const auto& [a, b, c] = mesh_.triangles[t];
            if (a == b || b == c || c == a) continue;
            good_.push_back(static_cast<int>(t));
            for (const int v : mesh_.triangles[t]) {
                body_[static_cast<std::size_t>(v)] = mesh_.triangle_body[t];
            }
        }
    }

    void make_patches() {
        s_.patch_vertices = {0};
        s_.strip_patches = {0};
        for (int strip = 0; strip < strips_.count(); ++strip) {
            const auto s = static_cast<std::size_t>(strip);
            std::vector<int> own;
            for (int v = strips_.begin[s]; v < strips_.begin[s + 1]; ++v) {
                if (body_[static_cast<std::size_t>(v)] >= 0) own.push_back(v);
            }
            std::ranges::stable_sort(own, {},
                                     [&](int v) { return body_[static_cast<std::size_t>(v)]; });
            add_patches(own);
            s_.strip_patches.push_back(s_.patch_count());
        }
    }

    /// own: body by body
    void add_patches(std::span<int> own) {
        while (!own.empty()) {
            const int body = body_[static_cast<std::size_t>(own.front())];
            const auto same = static_cast<std::size_t>(std::ranges::count_if(
                own, [&](int v) { return body_[static_cast<std::size_t>(v)] == body; }));
            bisect(own.first(same), mesh_.rest);
            cut(own.first(same), body, first_half(static_cast<int>(same)));
            own = own.subspan(same);
        }
    }

    /// As bisect() has ordered them: where it has cut.
    void cut(std::span<const int> vertices, int body, int half) {
        const int count = static_cast<int>(vertices.size());
        if (count > Surface::kPatchVertices) {
            const auto first = vertices.first(static_cast<std::size_t>(half));
            const auto rest = vertices.subspan(static_cast<std::size_t>(half));
            cut(first, body, first_half(half));
            cut(rest, body, first_half(count - half));
            return;
        }
        for (const int v : vertices) {
            number_[static_cast<std::size_t>(v)] = s_.vertex_count();
            s_.vertices.push_back(v);
            s_.knots.push_back(mesh_.knots[static_cast<std::size_t>(v)]);
            patch_of_.push_back(s_.patch_count());
        }
        s_.patch_body.push_back(body);
        s_.patch_vertices.push_back(s_.vertex_count());
    }

    int patch_of(int vertex) const { return patch_of_[static_cast<std::size_t>(vertex)]; }

    /// By the patch of the lowest vertex.
    void place_triangles() {
        const auto numbered = [&](int t) {
            Triangle corners = mesh_.triangles[static_cast<std::size_t>(t)];
            for (int& v : corners) v = number_[static_cast<std::size_t>(v)];
            return corners;
        };
        const auto patch = [&](int t) { return patch_of(std::ranges::min(numbered(t))); };
        std::ranges::stable_sort(good_, {}, patch);
        s_.patch_triangles.assign(static_cast<std::size_t>(s_.patch_count()) + 1, 0);
        for (const int t : good_) {
            ++s_.patch_triangles[static_cast<std::size_t>(patch(t)) + 1];
            s_.triangles.push_back(numbered(t));
            s_.mesh_triangles.push_back(t);
        }
        std::partial_sum(s_.patch_triangles.begin(), s_.patch_triangles.end(),
                         s_.patch_triangles.begin());
    }

    /// In the order of the lower vertex, and so by patches.
    void place_edges() {
        for (const Triangle& t : s_.triangles) {
            for (std::size_t k = 0; k < 3; ++k) {
                const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
                s_.edges.push_back({low, high});
            }
        }
        std::ranges::sort(s_.edges);
        s_.edges.erase(std::ranges::unique(s_.edges).begin(), s_.edges.end());
        s_.patch_edges.assign(static_cast<std::size_t>(s_.patch_count()) + 1, 0);
        for (const auto& edge : s_.edges) {
            ++s_.patch_edges[static_cast<std::size_t>(patch_of(edge[0])) + 1];
        }
        std::partial_sum(s_.patch_edges.begin(), s_.patch_edges.end(), s_.patch_edges.begin());
    }

    /// What of `elements` each vertex is a corner of.
    template <class Elements>
    Lists lists_at_vertices(const Elements& elements) const {
        std::vector<std::vector<int>> at(static_cast<std::size_t>(s_.vertex_count()));
        for (std::size_t e = 0; e < elements.size(); ++e) {
            for (const int v : elements[e])
                at[static_cast<std::size_t>(v)].push_back(static_cast<int>(e));
        }
        return flattened(at);
    }

    static Lists flattened(const std::vector<std::vector<int>>& rows) {
        Lists lists;
        for (const auto& row : rows) {
            lists.items.insert(lists.items.end(), row.begin(), row.end());
            lists.close();
        }
        return lists;
    }

    void find_incidence() {
        s_.triangles_at = lists_at_vertices(s_.triangles);
        s_.edges_at = lists_at_vertices(s_.edges);
        std::vector<std::vector<int>> ring(static_cast<std::size_t>(s_.vertex_count()));
        for (const auto& [low, high] : s_.edges) {
            ring[static_cast<std::size_t>(high)].push_back(low);
            ring[static_cast<std::size_t>(low)].push_back(high);
        }
        for (auto& row : ring) std::ranges::sort(row);
        s_.ring = flattened(ring);
    }

    void find_shared_features() {
        struct Side {
            int low, high, triangle, corner;
        };
        std::vector<Side> sides;
        for (int t = 0; t < s_.triangle_count(); ++t) {
            const Triangle& x = s_.triangles[static_cast<std::size_t>(t)];
            for (int k = 0; k < 3; ++k) {
                const auto [low, high] = std::minmax(x[static_cast<std::size_t>((k + 1) % 3)],
                                                     x[static_cast<std::size_t>((k + 2) % 3)]);
                sides.push_back({low, high, t, k});
            }
        }
        std::ranges::sort(sides, {}, [](const Side& a) {
            return std::tuple(a.low, a.high, a.triangle, a.corner);
        });
        s_.beyond.assign(s_.triangles.size(), {-1, -1, -1});
        s_.owned.assign(s_.triangles.size(), 0);
        const auto corner = [&](const Side& side) {
            return s_.triangles[static_cast<std::size_t>(side.triangle)]
                               [static_cast<std::size_t>(side.corner)];
        };
        for (std::size_t first = 0; first < sides.size();) {
            std::size_t end = first + 1;
            while (end < sides.size() && sides[end].low == sides[first].low &&
                   sides[end].high == sides[first].high) {
                ++end;
            }
            s_.owned[static_cast<std::size_t>(sides[first].triangle)] |= 1 << sides[first].corner;
            for (std::size_t i = first; i < end && end - first > 1; ++i) {
                const Side& other = sides[i == first ? first + 1 : first];
                s_.beyond[static_cast<std::size_t>(sides[i].triangle)]
                         [static_cast<std::size_t>(sides[i].corner)] = corner(other);
            }
            first = end;
        }
        own_corners();
    }

    void own_corners() {
        for (int v = 0; v < s_.vertex_count(); ++v) {
            const auto lowest = static_cast<std::size_t>(s_.triangles_at[v].front());
            const Triangle& t = s_.triangles[lowest];
            s_.owned[lowest] |= 8 << (std::ranges::find(t, v) - t.begin());
        }
    }

    void find_faces() {
        for (std::size_t p = 0; p < s_.patch_body.size(); ++p) {
            std::vector<int> faces;
            for (int t = s_.patch_triangles[p]; t < s_.patch_triangles[p + 1]; ++t) {
                faces.push_back(t);
            }
            const auto cover = [&](const std::vector<int>& triangles) {
                const auto is_face = [&](int t) {
                    return std::ranges::find(faces, t) != faces.end();
                };
                if (std::ranges::none_of(triangles, is_face)) faces.push_back(triangles.front());
            };
            for (int e = s_.patch_edges[p]; e < s_.patch_edges[p + 1]; ++e) {
                const auto [low, high] = s_.edges[static_cast<std::size_t>(e)];
                std::vector<int> common;
                std::ranges::set_intersection(s_.triangles_at[low], s_.triangles_at[high],
                                              std::back_inserter(common));
                cover(common);
            }
            for (int v = s_.patch_vertices[p]; v < s_.patch_vertices[p + 1]; ++v) {
                const auto at = s_.triangles_at[v];
                cover({at.begin(), at.end()});
            }
            s_.faces.items.insert(s_.faces.items.end(), faces.begin(), faces.end());
            s_.faces.close();
        }
    }

    void find_rims() {
        for (std::size_t p = 0; p < s_.patch_body.size(); ++p) {
            std::vector<int> rim;
            for (const int t : s_.faces[static_cast<int>(p)]) {
                const Triangle& x = s_.triangles[static_cast<std::size_t>(t)];
                rim.insert(rim.end(), x.begin(), x.end());
            }
            add_set(s_.rims, std::move(rim));
        }
    }

    void find_hulls() {
        for (std::size_t p = 0; p < s_.patch_body.size(); ++p) {
            std::vector<int> hull;
            for (int v = s_.patch_vertices[p]; v < s_.patch_vertices[p + 1]; ++v) hull.push_back(v);
            for (int t = s_.patch_triangles[p]; t < s_.patch_triangles[p + 1]; ++t) {
                const Triangle& x = s_.triangles[static_cast<std::size_t>(t)];
                hull.insert(hull.end(), x.begin(), x.end());
            }
            for (int e = s_.patch_edges[p]; e < s_.patch_edges[p + 1]; ++e) {
                const auto& x = s_.edges[static_cast<std::size_t>(e)];
                hull.insert(hull.end(), x.begin(), x.end());
            }
            add_set(s_.hulls, std::move(hull));
        }
    }

    void find_patches_at() {
        std::vector<std::vector<int>> at(static_cast<std::size_t>(s_.vertex_count()));
        for (int p = 0; p < s_.patch_count(); ++p) {
            for (const int v : s_.hulls[p]) at[static_cast<std::size_t>(v)].push_back(p);
        }
        s_.patches_at = flattened(at);
        for (std::size_t p = 0; p < s_.patch_body.size(); ++p) {
            std::vector<int> around;
            for (int v = s_.patch_vertices[p]; v < s_.patch_vertices[p + 1]; ++v) {
                const auto here = s_.patches_at[v];
                around.insert(around.end(), here.begin(), here.end());
            }
            add_set(s_.around, std::move(around));
        }
    }

    void add_turns() {
        const std::vector<double> notches = border_notches(s_, mesh_.rest);
        for (int p = 0; p < s_.patch_count(); ++p) {
            double sum = 0.0;
            for (const int v : s_.rims[p]) sum += notches[static_cast<std::size_t>(v)];
            s_.turns.push_back(sum);
        }
    }

    /// As of groups of one patch each.
    void find_beside() {
        std::vector<int> each(static_cast<std::size_t>(s_.patch_count()) + 1);
        std::iota(each.begin(), each.end(), 0);
        PatchGroups patches = find_groups(s_, each);
        s_.beside = std::move(patches.beside);
        s_.between = std::move(patches.between);
    }

    void mark_held() {
        for (int p = 0; p < s_.patch_count(); ++p) {
            s_.patch_held.push_back(std::ranges::all_of(s_.hulls[p], [&](int v) {
                return mesh_.held[static_cast<std::size_t>(
                           s_.vertices[static_cast<std::size_t>(v)])] != 0;
            }));
        }
    }

    const SurfaceMesh& mesh_;
    const Strips& strips_;
    std::vector<int> number_;    ///< [model vertices] of the surface
    std::vector<int> body_;      ///< [model vertices] -1: not of the surface
    std::vector<int> good_;      ///< triangles of the mesh
    std::vector<int> patch_of_;  ///< [vertices]
    Surface s_;
};

}  // namespace

Surface make_surface(const SurfaceMesh& mesh, const Strips& strips) {
    return Builder(mesh, strips).build();
}

}  // namespace weft
