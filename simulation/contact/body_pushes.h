#pragma once

#include <optional>

#include "runtime/planning/regions.h"
#include "runtime/row_table.h"
#include "runtime/step.h"
#include "simulation/contact/body_columns.h"
#include "simulation/contact/body_groups.h"
#include "simulation/contact/rows.h"
#include "simulation/contact/rubbing.h"

namespace weft {

/// The contacts of free bodies with others, once per side, as their momentum wants them: a row per
/// column (kernels/contact/pushes.h).
class BodyPushes {
public:
    /// contacts, columns: must outlive this. contacts: none in scenes that have none. multipliers:
    /// [entries of contacts] by which they press where rounds begin; null: they do so as their gaps
    /// say. h: the substep [s]
    BodyPushes(std::optional<ContactRows> contacts, const BodyColumns& columns, Rubbing rubbing,
               Buffer<float>* multipliers, double h);

    /// Collects them at these positions, those of all vertices. bodies: [vertices], as the
    /// kernel's; groups: null without contacts
    Launch collect(Buffer<float4>& positions, Buffer<float4>& targets, Buffer<int>& bodies,
                   BodyGroups* groups);
    /// What that needs of a region, besides the positions and the targets.
    void add_collect_accesses(Step::Adding& task, const Region& region, int first, int last);

    /// What collect_resting takes besides (kernels/contact/resting.h); all but the last three are
    /// its buffers.
    struct Resting {
        Buffer<float4>&positions, &previous, &seen_targets, &starts, &slips, &obstacles;
        Buffer<float>&borne, &solid, &hardness;
        Buffer<float4>* meetings;  ///< null: no obstacle is narrow
        Buffer<float>* gradients;  ///< null: there are no solids
        int body_count, obstacle_count;
        float reach;
    };
    /// Behind collect(), adds the vertices that are near convex obstacles.
    Launch collect_resting(const Resting& resting);

    /// What collect_stops takes besides (kernels/contact/stops.h); all but the last three are its
    /// buffers.
    struct Stops {
        Buffer<float4>&positions, &targets, &anchors;
        Buffer<float>& least;
        RowTable& planes_of;
        Buffer<float4>& planes;
        Buffer<float>& hardness;
        Buffer<int>& scene_bodies;
        Buffer<float>& borne;
        int body_count, scene_body_count;
        float soft;
    };
    /// Behind collect(), adds the vertices that inertia leads through planes.
    Launch collect_stops(const Stops& stops);

    /// The parameters of a round, as the kernel's.
    struct Round {
        int is_rubbed = 0, has_moved = 0, is_strained = 0, is_strain = 0, level = 0;
    };
    /// Adds up how far bodies lag behind, and how they are pushed (kernels/contact/bodies.h).
    /// All parameters as the kernel's.
    Launch add(Buffer<int>& column_bodies, Buffer<float>& masses, Buffer<float4>& moments,
               Buffer<float4>& motions, Buffer<float4>& strains, Buffer<float4>& bearings,
               const Round& round, Buffer<float4>& partials);
    /// What that needs of a region, besides the moments, the motions, the strains and the bearings.
    void add_sum_accesses(Step::Adding& task, const Region& region);

    RowTable& table() { return table_; }

private:
    std::optional<ContactRows> contacts_;
    BodyColumns columns_;
    float friction_, creep_, h2_;
    Buffer<float> none_;          ///< one, of no use
    Buffer<float>* multipliers_;  ///< null: none
    RowTable table_;
    Buffer<int>& codes_;
    Buffer<float4>&sides_, &slips_, &forces_, &points_, &other_points_;
    Buffer<float>& presses_;
    Buffer<float4> standing_;  ///< [columns]
};

}  // namespace weft
