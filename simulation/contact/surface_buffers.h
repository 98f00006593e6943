#pragma once

#include <string>
#include <vector>

#include "runtime/launch.h"
#include "simulation/contact/patch_groups.h"
#include "simulation/contact/surface.h"

namespace weft {

/// A Surface on the devices. Tables are column-major; vertices are those of the surface where
/// nothing else is said.
struct SurfaceBuffers {
    /// Ints that never change; a buffer has one element at least.
    struct Ints : Buffer<int> {
        Ints(const std::string& name, const std::vector<int>& values);
    };
    /// Items of all strips.
    struct Items {
        Items(const std::string& name, const std::vector<int>& strip_begin);
        int count() const { return segments.item(segments.strip_count); }
        Ints begin;
        Segments segments;
    };
    /// Where the items of each patch begin, and the patch of each item.
    struct Patched {
        Patched(const std::string& name, const std::vector<int>& patch_begin,
                const Surface& surface);
        Ints begin;    ///< [patches + 1]
        Ints patches;  ///< [items]
        Items items;
    };
    struct ListsOnDevice {
        ListsOnDevice(const std::string& name, const Lists& lists);
        Ints begin, items;
    };
    /// Boxes around boxes, of which each has so many children.
    struct Level {
        Level(const std::string& name, const std::vector<int>& strip_begin,
              const std::vector<int>& child_begin);
        Items items;
        Ints children;  ///< [items + 1] where those of each begin
        Buffer<float4> low, high;
    };

    SurfaceBuffers(const Surface& surface, const std::vector<Vec3>& rest);

    Patched vertices, triangles, edges;
    Ints model_vertices;  ///< [vertices]
    Ints knots;           ///< [vertices] Surface::knots
    Ints corners;         ///< [3 * triangles]
    Ints ends;            ///< [2 * edges]
    Ints beyond;          ///< [3 * triangles] Surface::beyond
    Ints owned;           ///< [6 * triangles] the bits of Surface::owned
    ListsOnDevice ring;
    Items patches;
    Ints face_begin;      ///< [patches + 1] Surface::faces
    Ints face_corners;    ///< [3 * faces] the model's vertices
    ListsOnDevice rims;   ///< the model's vertices
    ListsOnDevice hulls;  ///< likewise
    ListsOnDevice around;
    /// Surface::beside; each list ends with a number that is larger than any, and `vias` has which
    /// patch is between.
    Ints beside_begin, besides, vias;
    Ints bodies, held;  ///< [patches]
    Buffer<float>
        quiet;  ///< [patches] how far vertices may get before a triangle could turn over [m]
    Level groups, blocks, roots;
    Ints group_of;  ///< [patches]
    /// PatchGroups::beside, as those of patches.
    Ints group_beside_begin, group_besides, group_vias;

private:
    SurfaceBuffers(const Surface& surface, const std::vector<Vec3>& rest,
                   const PatchGroups& patch_groups);
};

}  // namespace weft
