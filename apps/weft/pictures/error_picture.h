#pragma once

#include "apps/weft/pictures/log_plot.h"
#include "simulation/output/error_file.h"

namespace weft {

/// Relative error against seconds, both logarithmic: one line per curve through every measured
/// point, colours by solver, line styles by devices and plan.
class ErrorPicture {
public:
    /// The study must outlive it.
    explicit ErrorPicture(const ErrorStudy& study);

    double width() const { return plot_.width(); }
    double height() const { return plot_.height(); }
    void draw(Canvas& canvas) const;

private:
    void draw_curve(Canvas& canvas, const ErrorCurve& curve, CurveStyle style) const;

    const ErrorStudy& study_;
    LogPlot plot_;
    std::vector<CurveStyle> styles_;  ///< by curve
};

}  // namespace weft
