#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/owned.h"
#include "simulation/families/family.h"
#include "simulation/mesh/triangle_mesh.h"
#include "simulation/model/edges.h"
#include "simulation/model/gathered.h"
#include "simulation/model/moving_pins.h"
#include "simulation/model/obstacles.h"
#include "simulation/scene/scene.h"

namespace weft {

/// A scene as buffers, in the order that strips and colours give it. Whatever the scene does not
/// name is not there. "Scene order" is the order of the meshes' vertices, cloth by cloth, then
/// solid by solid; "new order" is that of the buffers.
class Model {
public:
    /// Throws UserError for what is wrong with the scene's meshes, pins and attachments.
    Model(const Scene& scene, Warnings& warnings);
    /// Of a scene with its substeps, for a step alone: gives no warnings, and has no `edges`.
    explicit Model(const Scene& scene);

    int vertex_count() const { return static_cast<int>(strips.order.size()); }
    /// A vertex of the new order in scene order.
    SceneVertex scene_vertex(int vertex) const {
        return SceneVertex{strips.order[static_cast<std::size_t>(vertex)]};
    }
    /// The other way.
    int vertex(SceneVertex vertex) const { return strips.rank[index(vertex)]; }
    /// xyz in scene order, [3 * vertex_count()]. rows  float4 or Vec3 per vertex, in new order.
    /// Positions count from `origin`, before and after.
    template <class Rows>
    std::vector<float> in_scene_order(const Rows& rows) const;
    /// The other way: xyz of every row; what else a row has stays as it is.
    template <class Rows>
    void from_scene_order(std::span<const float> xyz, Rows&& rows) const;
    /// A position in the scene's own coordinates [m].
    Vec3 in_scene(Vec3 position) const { return position + origin; }
    /// Positions in scene order, as in_scene_order() gives them, in the scene's own coordinates:
    /// far from the scene's origin they lose digits by that.
    std::vector<float> in_scene(std::vector<float> xyz) const;
    /// The other way.
    std::vector<float> from_origin(std::vector<float> xyz) const;
    /// Fills in what moves by itself during the frame that begins at `time`.
    void place(double time);
    /// The buffers that place() writes.
    std::vector<BufferStorage*> placed_buffers();

    /// Whose triangle it is: a number of `bodies`.
    std::size_t body_of_triangle(int triangle) const;
    /// All elements, in new vertices: who touches whom.
    std::vector<Stencils> stencils() const;
    /// The family of that class; null: the scene has no elements of it.
    template <class Family>
    Family* find() {
        return find_in<Family>(families);
    }
    template <class Family>
    const Family* find() const {
        return find_in<const Family>(families);
    }

    /// The vertices of each strip, as items.
    const Segments& vertices() const { return vertices_; }

    const Scene scene;  ///< as given, with substeps and thickness chosen where left out
    const double h;     ///< one substep [s]
    /// In the scene's own coordinates [m]: the place that all positions of the model count from,
    /// in buffers and elsewhere; see origin.h. All models of a scene's bodies have the same.
    const Vec3 origin;
    /// The scene's, counted from there. (The scene itself is as given.)
    const std::vector<Obstacle> convex_obstacles;

    // As the scene has it (scene order).
    std::vector<BodyRange> bodies;
    std::vector<std::array<int, 3>> triangles;  ///< of cloths all, of solids their surface

    // On the devices (new order).
    Strips strips;
    Owned<Buffer<float4>> positions;   ///< xyz [m], w = 1/mass [1/kg], 0 for held vertices
    Owned<Buffer<float4>> previous;    ///< xyz at the substep's start
    Owned<Buffer<float4>> velocities;  ///< xyz [m/s], w = what damping leaves per substep
    Owned<Buffer<float4>> gravity;     ///< [substeps] xyz [m/s^2]
    std::vector<double> masses;        ///< [kg]; of held vertices, too
    bool damped = false;

    /// Those that the scene has elements of, in the order of element_families.h.
    std::vector<Owned<ElementFamily>> families;
    Owned<Edges> edges;
    Owned<MovingPins> moving_pins;  ///< null: no pin moves
    Owned<Obstacles> obstacles;     ///< null: none

private:
    Model(const Scene& scene, Gathered all, Warnings* warnings);
    void make_vertices(const Gathered& all);
    MovingSurface moving_surface() const;
    template <class Family, class Families>
    static Family* find_in(Families& families) {
        for (auto& family : families) {
            if (auto* found = dynamic_cast<Family*>(family.get())) return found;
        }
        return nullptr;
    }

    Owned<Buffer<int>> strip_begin_;
    Segments vertices_;
};

template <class Rows>
std::vector<float> Model::in_scene_order(const Rows& rows) const {
    std::vector<float> xyz(3 * rows.size());
    for (std::size_t v = 0; v < rows.size(); ++v) {
        float* to = &xyz[3 * static_cast<std::size_t>(strips.order[v])];
        to[0] = static_cast<float>(rows[v].x);
        to[1] = static_cast<float>(rows[v].y);
        to[2] = static_cast<float>(rows[v].z);
    }
    return xyz;
}

template <class Rows>
void Model::from_scene_order(std::span<const float> xyz, Rows&& rows) const {
    for (std::size_t v = 0; v < rows.size(); ++v) {
        const float* from = &xyz[3 * static_cast<std::size_t>(strips.order[v])];
        rows[v].x = from[0];
        rows[v].y = from[1];
        rows[v].z = from[2];
    }
}

}  // namespace weft
