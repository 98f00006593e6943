#pragma once

#include <string>
#include <vector>

#include "runtime/planning/partition.h"
#include "simulation/contact/candidates.h"

namespace weft {

struct PairSettings {
    float thickness = 0.0f;  ///< from where on two surfaces push each other [m]
    float least = 0.0f;      ///< what they keep in any case [m]
    bool self = true;        ///< a body with itself, too
    /// Of the tables' rows at the beginning: so many vertices near a triangle, twice as many
    /// triangles and edges, and eight times as many patches. A frame that needs more is run again.
    int room = 4;
};

/// Finds in every substep, on the devices, what may touch: vertices and triangles, edges and edges.
/// Both sides of a pair find it by themselves. kernels/contact/pairs.h says what a pair is.
///
/// Three tasks per part, one after the other: `boxes`, of the part's strips; `near`, which needs
/// the boxes of all strips, finds patches near to each other; `pairs`, which needs what `near` has
/// found in all strips, fills the tables, from candidates that last for some substeps.
class ContactPairs {
public:
    /// A table of pairs. An entry is 2 * the number of the other one, + 1 if they push each other;
    /// without, they may meet if their vertices go as far as they may. Rows ascend. (Of `near`: the
    /// number.)
    using Table = PairTable;
    static std::vector<std::string> kinds() { return {"boxes", "near", "pairs"}; }

    /// rest        [model vertices] [m] as the surface was made with
    /// anchors     [model vertices] xyz [m], w = how far from there the vertex may get in this
    ///             substep, at least a quarter of the thickness, so that whatever is nearer than
    ///             the thickness is found [m]; somebody else's task writes them, before `boxes`
    /// goals       [model vertices] xyz: where inertia, or the scene, leads in the substep [m];
    ///             likewise. They count where foresees() says so
    /// strides     [model vertices] what has changed of the anchors, see PairCandidates; likewise
    /// strips      the model's vertices, as the surface was made with
    /// first_kind  the kinds of the tasks are this and the two behind it
    ContactPairs(Surface surface, const std::vector<Vec3>& rest, Buffer<float4>& anchors,
                 Buffer<float4>& goals, Buffer<float4>& strides, const Segments& strips,
                 const PairSettings& settings, int first_kind);

    std::vector<const TaskBody*> bodies() const { return {&boxes_, &near_task_, &pairs_}; }
    std::vector<RowTable*> tables();
    void add_boxes(Step& step, const Part& part, RegionId region);
    void add_near(Step& step, const Part& part, RegionId region);
    void add_pairs(Step& step, const Part& part, RegionId region);

    const Surface& surface() const { return surface_; }
    const PairSettings& settings() const { return settings_; }
    Table& near() { return near_; }  ///< of patches: patches
    /// [strips] 1 where a patch has one near to it, else 0; the task `near` writes them.
    Buffer<int>& near_strips() { return near_strips_; }
    Table& vt() { return vt_; }  ///< of vertices: triangles
    Table& tv() { return tv_; }  ///< of triangles: vertices
    Table& ee() { return ee_; }  ///< of edges: edges
    PairCandidates& candidates() { return candidates_; }
    /// The surface, and its items by strips.
    SurfaceBuffers& buffers() { return s_; }
    /// [vertices of the surface] their anchors.
    Buffer<float4>& points() { return points_; }
    /// [1] not 0: what inertia leads alike counts as quiet, and somebody looks whether it went
    /// there (kernels/contact/quiet.h). At the beginning 0.
    Buffer<int>& foresees() { return foresees_; }
    /// [patches] boxes around all that their vertices may reach, and a quarter of the thickness.
    Buffer<float4>& patch_low() { return patch_low_; }
    Buffer<float4>& patch_high() { return patch_high_; }

private:
    void make_boxes_body(int kind);
    void make_near_body(int kind);
    void make_pairs_body(int kind);
    void add_collecting(std::vector<Launch>& launches);
    void add_choosing(std::vector<Launch>& launches);

    Surface surface_;
    SurfaceBuffers s_;
    PairSettings settings_;
    float halo_;  ///< half of the thickness
    Buffer<float4>&anchors_, &goals_, &strides_;
    Segments strips_;
    Buffer<int> foresees_{"contact.foresees", 1};
    Buffer<float4> points_;
    Buffer<float> worn_;
    Buffer<float4> tilts_, drifts_, group_tilts_;
    Buffer<int> group_opens_;
    Buffer<int> near_strips_, awake_;  ///< [strips] kernels/contact/gates.h
    Buffer<float4> patch_low_, patch_high_, slant_low_, slant_high_;
    Buffer<float4> group_slant_low_, group_slant_high_;
    Buffer<float4> triangle_low_, triangle_high_, edge_low_, edge_high_;
    Table near_, vt_, tv_, ee_;
    PairCandidates candidates_;
    TaskBody boxes_, near_task_, pairs_;
};

}  // namespace weft
