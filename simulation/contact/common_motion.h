#pragma once

#include <memory>
#include <vector>

#include "runtime/buffer.h"
#include "simulation/contact/body_groups.h"
#include "simulation/contact/foreseen_motion.h"
#include "simulation/contact/interval_box.h"
#include "simulation/contact/surface.h"
#include "simulation/model/model.h"

namespace weft {

/// What bodies near each other do together: one translation u for each group of bodies that may
/// meet in a substep. Contact's planes and balls move with it (kernels/contact/begin.h), so that a
/// pile that flies, however fast, is to contact a pile at rest. A group with a held vertex has
/// u = 0, as has what moves by less than an eighth of the thickness. Before convex obstacles u ends
/// where the first of the group comes to one: planes that stayed where they are held back what came
/// behind it by more than the gap between them.
///
/// The groups of a frame's substeps are foreseen at its start, from the bodies' velocities and
/// gravity. Different groups have fences that are apart (kernels/contact/fences.h): what leaves its
/// own was not foreseen, and the frame has to be done again (revise()). So a wrong guess costs
/// time, and no guarantee.
///
/// Likewise who may be pushed by what the scene leads: bodies that may meet it in the frame, and
/// what they may meet.
class CommonMotion {
public:
    /// thickness [m] of contact, margin: by how much boxes of patches go beyond the way that their
    /// vertices make by inertia, and as the scene leads others [m]; foresees: that of ContactPairs
    CommonMotion(const Model& model, const Surface& surface, double thickness, double margin,
                 Buffer<int>& foresees);

    /// Fills in the frame that begins at `time`, from the state at its start.
    void place(double time);
    /// After the frame, strays() and unquiet() being the host's: whether somebody left a fence, or
    /// patches got loose that were taken for quiet. Then the frame has to be done again, and is
    /// filled in with less foreseen: at last with all bodies as one group that stays where it is.
    bool revise();
    std::vector<BufferStorage*> placed_buffers();

    /// From now on frames are filled in with the groups of bodies that are parts of the scene's, or
    /// several of them; see BodyGroups.
    BodyGroups& group(std::vector<std::vector<int>> parts);

    int body_count() const { return static_cast<int>(bodies().size()); }
    int chunk_count() const { return static_cast<int>(chunks().size()); }
    Buffer<int>& body_of() { return body_of_; }     ///< [model vertices]
    Buffer<float4>& carried() { return carried_; }  ///< [substeps * bodies] see begin.h
    Buffer<float>& borne() { return borne_; }       ///< [substeps * bodies] see stops.h
    Buffer<int>& chunk_of() { return chunk_of_; }   ///< [patches]
    Buffer<float4>& fences() { return fences_; }    ///< [substeps * 2 * chunks] see fences.h
    Buffer<int>& strays() { return strays_; }       ///< [patches] written by the devices
    Buffer<int>& unquiet() { return unquiet_; }     ///< [vertices] likewise; see quiet.h

private:
    struct Groups {
        std::vector<int> of;            ///< [bodies] the lowest of its group
        std::vector<char> has_arrived;  ///< [bodies] at an obstacle
    };

    const std::vector<ForeseenMotion::Body>& bodies() const { return foreseen_.bodies(); }
    const std::vector<ForeseenMotion::Chunk>& chunks() const { return foreseen_.chunks(); }
    void hold();
    void place_substep(int substep, Groups& known);
    /// Of bodies in groups: with which the group moves as far as all of it can, 0 where it does
    /// not. room: [bodies] that obstacles leave [m]
    std::vector<Vec3> common_velocities(int substep, const std::vector<int>& groups,
                                        const std::vector<double>& room) const;
    std::vector<Vec3> centres() const;
    std::vector<int> free_groups(const std::vector<IntervalBox>& boxes) const;
    bool block(int substep, const std::vector<Vec3>& together, std::vector<double>& room) const;
    /// That a body would go by itself in a substep [m].
    double way_of(std::size_t body, int substep) const;
    std::vector<double> ways_back(int substep, const std::vector<int>& groups,
                                  const std::vector<Vec3>& together,
                                  const std::vector<double>& room) const;
    std::vector<IntervalBox> reached(int substep, const std::vector<Vec3>& together,
                                     const std::vector<double>& back) const;
    std::vector<char> split_groups(const std::vector<int>& groups,
                                   const std::vector<Vec3>& together) const;
    void build_fences(int substep, const std::vector<char>& is_split,
                      const std::vector<IntervalBox>& boxes);
    void open_fences(int substep);
    void carry(int substep, const std::vector<Vec3>& together, const std::vector<double>& back);
    void find_borne(int substep, const std::vector<int>& groups, const std::vector<double>& room);

    const Model& model_;
    double thickness_;
    int substeps_;
    ForeseenMotion foreseen_;
    Buffer<int>& foresees_;
    Buffer<int> body_of_, chunk_of_, strays_, unquiet_;
    Buffer<float4> carried_, fences_;
    Buffer<float> borne_;
    std::unique_ptr<BodyGroups> grouped_;  ///< null: nobody asked for groups
};

}  // namespace weft
