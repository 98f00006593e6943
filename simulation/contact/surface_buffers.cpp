#include "simulation/contact/surface_buffers.h"

#include <algorithm>
#include <limits>

namespace weft {

namespace {

/// Boxes in each box of the next level.
constexpr int kChildren = 8;
/// Of the least height of its triangles at rest: two vertices that go towards each other, each by
/// less than half of it, leave every triangle on its side. A tenth is for what is compressed.
constexpr double kQuiet = 0.4;

/// Of rows that all have as many elements.
template <class Rows>
std::vector<int> column_major(const Rows& rows) {
    std::vector<int> columns;
    if (rows.empty()) return columns;
    for (std::size_t k = 0; k < rows.front().size(); ++k) {
        for (const auto& row : rows) columns.push_back(row[k]);
    }
    return columns;
}

std::vector<int> in_model(std::vector<int> vertices, const Surface& surface) {
    for (int& v : vertices) v = surface.vertices[static_cast<std::size_t>(v)];
    return vertices;
}

/// Where the items of each strip begin, from where those of its patches do.
std::vector<int> by_strips(const std::vector<int>& patch_begin, const Surface& surface) {
    std::vector<int> begin;
    for (const int patch : surface.strip_patches) {
        begin.push_back(patch_begin[static_cast<std::size_t>(patch)]);
    }
    return begin;
}

std::vector<int> patches_of_items(const std::vector<int>& patch_begin) {
    std::vector<int> patches(static_cast<std::size_t>(patch_begin.back()));
    for (std::size_t p = 0; p + 1 < patch_begin.size(); ++p) {
        std::fill(patches.begin() + patch_begin[p], patches.begin() + patch_begin[p + 1],
                  static_cast<int>(p));
    }
    return patches;
}

std::vector<int> owned_columns(const std::vector<int>& owned) {
    std::vector<int> columns;
    for (int bit = 0; bit < 6; ++bit) {
        for (const int bits : owned) columns.push_back(bits >> bit & 1);
    }
    return columns;
}

/// Where the parents of boxes begin, strip by strip, and where the children of each.
struct Parents {
    std::vector<int> strip_begin{0};
    std::vector<int> child_begin{0};
};

Parents grouped(const std::vector<int>& strip_begin) {
    Parents parents;
    for (std::size_t s = 0; s + 1 < strip_begin.size(); ++s) {
        for (int first = strip_begin[s]; first < strip_begin[s + 1]; first += kChildren) {
            parents.child_begin.push_back(std::min(first + kChildren, strip_begin[s + 1]));
        }
        parents.strip_begin.push_back(static_cast<int>(parents.child_begin.size()) - 1);
    }
    return parents;
}

/// One per strip, also of none.
Parents one_per_strip(const std::vector<int>& strip_begin) {
    Parents parents{{0}, strip_begin};
    for (std::size_t s = 1; s < strip_begin.size(); ++s) {
        parents.strip_begin.push_back(static_cast<int>(s));
    }
    return parents;
}

SurfaceBuffers::Level make_level(const std::string& name, const Parents& parents) {
    return {name, parents.strip_begin, parents.child_begin};
}

std::vector<std::array<int, 3>> corners_of_faces(const Surface& surface) {
    std::vector<std::array<int, 3>> corners;
    for (const int t : surface.faces.items) {
        corners.push_back(surface.triangles[static_cast<std::size_t>(t)]);
    }
    return corners;
}

/// Each list with an end: a number that is larger than any.
Lists ended(const Lists& lists) {
    Lists with_ends;
    for (int i = 0; i < lists.count(); ++i) {
        with_ends.items.insert(with_ends.items.end(), lists[i].begin(), lists[i].end());
        with_ends.items.push_back(std::numeric_limits<int>::max());
        with_ends.close();
    }
    return with_ends;
}

/// What stands beside the items of ended lists.
std::vector<int> beside_ended(const Lists& lists, const std::vector<int>& beside) {
    std::vector<int> with_ends;
    for (std::size_t i = 0; i + 1 < lists.begin.size(); ++i) {
        with_ends.insert(with_ends.end(), beside.begin() + lists.begin[i],
                         beside.begin() + lists.begin[i + 1]);
        with_ends.push_back(0);
    }
    return with_ends;
}

double least_height(const std::array<int, 3>& corners, const Surface& surface,
                    const std::vector<Vec3>& rest) {
    std::array<Vec3, 3> x;
    for (std::size_t k = 0; k < 3; ++k) {
        x[k] =
            rest[static_cast<std::size_t>(surface.vertices[static_cast<std::size_t>(corners[k])])];
    }
    const double longest =
        std::max({length(x[1] - x[0]), length(x[2] - x[1]), length(x[0] - x[2])});
    return longest > 0.0 ? length(cross(x[1] - x[0], x[2] - x[0])) / longest : 0.0;
}

}  // namespace

SurfaceBuffers::Ints::Ints(const std::string& name, const std::vector<int>& values)
    : Buffer<int>("contact." + name, std::max(values.size(), std::size_t{1})) {
    std::ranges::copy(values, data());
}

SurfaceBuffers::Items::Items(const std::string& name, const std::vector<int>& strip_begin)
    : begin(name + ".strips", strip_begin),
      segments{&begin, 0, 1, static_cast<int>(strip_begin.size()) - 1} {}

SurfaceBuffers::Patched::Patched(const std::string& name, const std::vector<int>& patch_begin,
                                 const Surface& surface)
    : begin(name + ".begin", patch_begin),
      patches(name + ".patches", patches_of_items(patch_begin)),
      items(name, by_strips(patch_begin, surface)) {}

SurfaceBuffers::ListsOnDevice::ListsOnDevice(const std::string& name, const Lists& lists)
    : begin(name + ".begin", lists.begin), items(name, lists.items) {}

SurfaceBuffers::Level::Level(const std::string& name, const std::vector<int>& strip_begin,
                             const std::vector<int>& child_begin)
    : items(name, strip_begin),
      children(name + ".children", child_begin),
      low("contact." + name + ".low", child_begin.size()),
      high("contact." + name + ".high", child_begin.size()) {}

SurfaceBuffers::SurfaceBuffers(const Surface& s, const std::vector<Vec3>& rest)
    : SurfaceBuffers(s, rest, find_groups(s, grouped(s.strip_patches).child_begin)) {}

SurfaceBuffers::SurfaceBuffers(const Surface& s, const std::vector<Vec3>& rest,
                               const PatchGroups& patch_groups)
    : vertices("vertices", s.patch_vertices, s),
      triangles("triangles", s.patch_triangles, s),
      edges("edges", s.patch_edges, s),
      model_vertices("model_vertices", s.vertices),
      knots("knots", s.knots),
      corners("corners", column_major(s.triangles)),
      ends("ends", column_major(s.edges)),
      beyond("beyond", column_major(s.beyond)),
      owned("owned", owned_columns(s.owned)),
      ring("ring", s.ring),
      patches("patches", s.strip_patches),
      face_begin("faces.begin", s.faces.begin),
      face_corners("faces.corners", in_model(column_major(corners_of_faces(s)), s)),
      rims("rims", {s.rims.begin, in_model(s.rims.items, s)}),
      hulls("hulls", {s.hulls.begin, in_model(s.hulls.items, s)}),
      around("around", s.around),
      beside_begin("beside.begin", ended(s.beside).begin),
      besides("besides", ended(s.beside).items),
      vias("vias", beside_ended(s.beside, s.between)),
      bodies("bodies", s.patch_body),
      held("held", {s.patch_held.begin(), s.patch_held.end()}),
      quiet("contact.quiet", std::max(s.patch_body.size(), std::size_t{1})),
      groups(make_level("groups", grouped(s.strip_patches))),
      blocks(make_level("blocks", grouped(grouped(s.strip_patches).strip_begin))),
      roots(make_level("roots",
                       one_per_strip(grouped(grouped(s.strip_patches).strip_begin).strip_begin))),
      group_of("group_of", patch_groups.of_patch),
      group_beside_begin("groups.beside.begin", ended(patch_groups.beside).begin),
      group_besides("groups.besides", ended(patch_groups.beside).items),
      group_vias("groups.vias", beside_ended(patch_groups.beside, patch_groups.between)) {
    for (int p = 0; p < s.patch_count(); ++p) {
        double least = std::numeric_limits<double>::max();
        for (const int t : s.faces[p]) {
            least =
                std::min(least, least_height(s.triangles[static_cast<std::size_t>(t)], s, rest));
        }
        quiet[static_cast<std::size_t>(p)] = static_cast<float>(kQuiet * least);
    }
}

}  // namespace weft
