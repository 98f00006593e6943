#pragma once

#include "apps/weft/pictures/log_plot.h"
#include "simulation/output/trajectory_file.h"

namespace weft {

/// Distance from the reference against the run time of whole runs, both logarithmic: a mark per
/// run, thin lines from fewer to more iterations with the same substeps, and the Pareto front,
/// labelled with substeps x iterations.
class TrajectoryPicture {
public:
    /// The study must outlive it.
    explicit TrajectoryPicture(const TrajectoryStudy& study);

    double width() const { return plot_.width(); }
    double height() const { return plot_.height(); }
    void draw(Canvas& canvas) const;

private:
    void draw_curve(Canvas& canvas, const TrajectoryCurve& curve, CurveStyle style) const;
    void draw_front(Canvas& canvas) const;

    const TrajectoryStudy& study_;
    LogPlot plot_;
    std::vector<CurveStyle> styles_;  ///< by curve
};

}  // namespace weft
