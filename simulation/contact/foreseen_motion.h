#pragma once

#include <utility>
#include <vector>

#include "simulation/contact/interval_box.h"
#include "simulation/contact/obstacle_boxes.h"
#include "simulation/contact/surface.h"
#include "simulation/model/model.h"

namespace weft {

/// How far bodies and chunks of them may get in the frame that is to come, and so who may meet whom
/// in it: foreseen from their velocities, from gravity, and from what the scene leads. Of
/// CommonMotion, which has the numbers' meaning.
class ForeseenMotion {
public:
    struct Body {
        double mass = 0.0;
        bool is_held = false;
        // Of the frame.
        std::vector<Vec3> velocity{};  ///< [substeps] with which it would fall freely [m/s]
        double led = 0.0;     ///< the farthest that the scene leads what may push its group [m]
        int group = 0;        ///< of bodies that may meet in the frame
        IntervalBox swept{};  ///< all that it may reach in the frame
    };
    /// Some patches of one body that follow each other.
    struct Chunk {
        int body = 0;
        std::vector<int> vertices{};  ///< the model's, of all its triangles
        bool falls = false;           ///< something of it is free
        // Of the frame.
        IntervalBox place{}, velocity{}, swept{};
        double clearance = 0.0;  ///< that it may take beyond what it needs [m]
    };
    using Pair = std::pair<int, int>;

    /// thickness, margin [m]: as of CommonMotion
    ForeseenMotion(const Model& model, const Surface& surface, double thickness, double margin);

    /// Of the frame that begins at `time`, from the state at its start.
    void place(double time);
    /// From now on in this frame all are pushed as far as those that are pushed farthest.
    void lead_alike();

    const std::vector<int>& body_of() const { return body_of_; }    ///< [model vertices]
    const std::vector<int>& chunk_of() const { return chunk_of_; }  ///< [patches]
    const std::vector<Body>& bodies() const { return bodies_; }
    const std::vector<Chunk>& chunks() const { return chunks_; }
    const ObstacleBoxes& obstacles() const { return obstacles_; }
    /// Chunks of different bodies that may meet in the frame.
    const std::vector<Pair>& near() const { return near_; }
    /// Chunks, and obstacles that they may meet in the frame.
    const std::vector<Pair>& in_the_way() const { return in_the_way_; }
    /// What a chunk and its boxes may reach in a substep, if its group moves with `together`.
    IntervalBox reached(const Chunk& chunk, int substep, Vec3 together) const;
    /// Where a chunk is when a substep begins, if nothing has met it.
    IntervalBox begin_of(const Chunk& chunk, int substep) const;

private:
    std::vector<Chunk> make_chunks(const Surface& surface) const;
    void make_bodies();
    void add_up_gravity();
    void look_at_bodies(double time);
    std::vector<double> ways_of_held(double time) const;
    void look_at_chunks();
    void find_neighbours();
    bool share_what_leads();
    void find_clearance();

    const Model& model_;
    double thickness_, margin_;
    int substeps_;
    std::vector<int> body_of_, chunk_of_;
    std::vector<Body> bodies_;
    std::vector<int> held_;  ///< vertices
    std::vector<Chunk> chunks_;
    ObstacleBoxes obstacles_;
    std::vector<Pair> near_, in_the_way_;
    std::vector<Vec3> gained_, fallen_;  ///< [substeps + 1] by gravity since the frame's start
};

}  // namespace weft
