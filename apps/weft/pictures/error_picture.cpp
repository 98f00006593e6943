#include "apps/weft/pictures/error_picture.h"

#include <fmt/format.h>

namespace weft {

namespace {

std::string title_of(const ErrorStudy& study) {
    return fmt::format("{}, frame {}: one step of {:.3g} ms, {} vertices", study.scene, study.frame,
                       1e3 * study.step, study.vertices);
}

}  // namespace

ErrorPicture::ErrorPicture(const ErrorStudy& study)
    : study_(study),
      plot_(title_of(study), "run time of the step [s]", "relative error (E - E*) / (E0 - E*)") {
    std::vector<std::string> solvers, lists;
    for (const ErrorCurve& curve : study.curves) {
        styles_.push_back(
            {number_of(solvers, curve.solver), number_of(lists, curve.devices + ' ' + curve.plan)});
        plot_.add_legend(fmt::format("{}, {}", curve.solver, curve.plan), curve.devices,
                         styles_.back());
        for (const ErrorPoint& p : curve.points) {
            plot_.include(p.time, p.relative_error);
            plot_.include(p.time, 1.0);  // the start, whose time 0 has no place on the axis
        }
    }
}

void ErrorPicture::draw(Canvas& canvas) const {
    plot_.draw_frame(canvas);
    plot_.draw_level(canvas, study_.rounding_floor, "E* rounded to float32");
    for (std::size_t c = 0; c < styles_.size(); ++c) {
        draw_curve(canvas, study_.curves[c], styles_[c]);
    }
}

void ErrorPicture::draw_curve(Canvas& canvas, const ErrorCurve& curve, CurveStyle style) const {
    Point last = plot_.left_at(1.0);
    for (const ErrorPoint& p : curve.points) {
        if (!LogPlot::has_place(p.time, p.relative_error)) continue;
        const Point at = plot_.at(p.time, p.relative_error);
        plot_.draw_line(canvas, last, at, style, 1.5);
        plot_.draw_mark(
            canvas, at, style,
            fmt::format("{} on {}, {}: {} iterations, {:.3g} ms, {:.2e}", curve.solver,
                        curve.devices, curve.plan, p.iteration, 1e3 * p.time, p.relative_error));
        last = at;
    }
}

}  // namespace weft
