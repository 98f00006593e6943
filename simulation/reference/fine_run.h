#pragma once

#include <memory>
#include <vector>

#include "simulation/model/model.h"

namespace weft {

/// A whole run in double precision by steps so small that nothing has to be solved: forces at a
/// step's start give the velocities (symplectic Euler), vertices go with these, obstacles push them
/// out as they do in every solver, and damping takes its part. As steps shrink, it tends to what
/// all solvers tend to; rounding, which stops these from being run with such steps in single
/// precision, is no matter here.
class FineRun {
public:
    /// From the model's positions and velocities, which are at time 0. The model must outlive it.
    /// Places its families for each of the run's steps.
    FineRun(Model& model, int substeps);

    /// So many per frame that a step is half as long as the longest stable one, or shorter: at the
    /// start, and as long as nothing gets much stiffer than it is there.
    static int stable_substeps(const Model& model);

    /// The next frame. Throws RunError if a vertex is no longer anywhere.
    void advance();
    /// xyz of all vertices in scene order, counted from the model's origin [m].
    std::vector<float> positions() const;

private:
    void step(double time);
    void add_forces();
    void push_out_of_obstacles(std::size_t vertex, Vec3 previous);

    Model& model_;
    const int substeps_;
    const double h_;  ///< [s]
    int frame_ = 0;
    std::unique_ptr<Obstacles> obstacles_;  ///< null: none
    // [vertices] new order.
    std::vector<Vec3> x_, velocities_, forces_, held_;
    std::vector<double> inverse_masses_;  ///< [1/kg], 0 for held ones
    std::vector<double> damping_;         ///< what a step leaves of the velocity
};

}  // namespace weft
