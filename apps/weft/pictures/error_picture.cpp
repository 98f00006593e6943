#include "apps/weft/pictures/error_picture.h"

#include <fmt/format.h>

#include "apps/weft/pictures/shifted_canvas.h"

namespace weft {

namespace {

std::string title_of(const ErrorStudy& study) {
    return fmt::format("{}, frame {}: one step of {:.3g} ms, {} vertices", study.scene, study.frame,
                       1e3 * study.step, study.vertices);
}

double time_of(const ErrorPoint& p) { return p.time; }
double iterations_of(const ErrorPoint& p) { return p.iteration; }

std::string note_of(const ErrorCurve& curve, const ErrorPoint& p) {
    return fmt::format("{} on {}, {}: {} iterations, {:.3g} ms, {:.2e}", curve.solver,
                       curve.devices, curve.plan, p.iteration, 1e3 * p.time, p.relative_error);
}

}  // namespace

ErrorPicture::ErrorPicture(const ErrorStudy& study)
    : study_(study),
      times_(title_of(study), "run time of the step [s]", "relative error (E - E*) / (E0 - E*)"),
      iterations_("", "iterations", "relative error"),
      styles_(curve_styles(study.curves)) {
    for (std::size_t c = 0; c < styles_.size(); ++c) {
        const ErrorCurve& curve = study.curves[c];
        times_.add_legend(fmt::format("{}, {}", curve.solver, curve.plan), curve.devices,
                          styles_[c]);
        for (const ErrorPoint& p : curve.points) {
            times_.include(p.time, p.relative_error);
            times_.include(p.time, 1.0);  // the start, whose time 0 has no place on the axis
            iterations_.include(p.iteration, p.relative_error);
            iterations_.include(p.iteration, 1.0);
        }
    }
    iterations_.set_height_of(times_);
}

void ErrorPicture::draw(Canvas& canvas) const {
    draw_plot(canvas, times_, time_of, true);
    ShiftedCanvas beside(canvas, times_.width());
    draw_plot(beside, iterations_, iterations_of, false);
}

void ErrorPicture::draw_plot(Canvas& canvas, const LogPlot& plot, XOf x_of, bool has_notes) const {
    plot.draw_frame(canvas);
    plot.draw_level(canvas, study_.rounding_floor, "E* rounded to float32");
    for (std::size_t c = 0; c < styles_.size(); ++c) {
        const ErrorCurve& curve = study_.curves[c];
        Point last = plot.left_at(1.0);
        for (const ErrorPoint& p : curve.points) {
            if (!LogPlot::has_place(x_of(p), p.relative_error)) continue;
            const Point at = plot.at(x_of(p), p.relative_error);
            plot.draw_line(canvas, last, at, styles_[c], 1.5);
            plot.draw_mark(canvas, at, styles_[c], has_notes ? note_of(curve, p) : "");
            last = at;
        }
    }
}

}  // namespace weft
