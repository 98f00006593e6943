#pragma once

#include "apps/weft/pictures/log_plot.h"
#include "simulation/output/error_file.h"

namespace weft {

/// Relative error against seconds, and beside it against iterations, all logarithmic: one line per
/// curve through every measured point, colours by solver (by plan, where there is one solver), line
/// styles by devices and plan.
class ErrorPicture {
public:
    /// The study must outlive it.
    explicit ErrorPicture(const ErrorStudy& study);

    double width() const { return times_.width() + iterations_.width(); }
    double height() const { return times_.height(); }
    void draw(Canvas& canvas) const;

private:
    using XOf = double (*)(const ErrorPoint&);
    void draw_plot(Canvas& canvas, const LogPlot& plot, XOf x_of, bool has_notes) const;

    const ErrorStudy& study_;
    LogPlot times_, iterations_;
    std::vector<CurveStyle> styles_;  ///< by curve
};

}  // namespace weft
