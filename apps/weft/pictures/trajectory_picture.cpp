#include "apps/weft/pictures/trajectory_picture.h"

#include <fmt/format.h>

#include <algorithm>

namespace weft {

namespace {

constexpr Colour kInk{40, 40, 40};

std::string title_of(const TrajectoryStudy& study) {
    return fmt::format("{}: {} frames of {:.3g} ms, {} vertices", study.scene, study.frames,
                       1e3 * study.frame_time, study.vertices);
}

}  // namespace

TrajectoryPicture::TrajectoryPicture(const TrajectoryStudy& study)
    : study_(study),
      plot_(title_of(study), "run time of all frames [s]",
            "RMS distance of vertices from the reference [m]"),
      styles_(curve_styles(study.curves)) {
    for (std::size_t c = 0; c < study.curves.size(); ++c) {
        const TrajectoryCurve& curve = study.curves[c];
        plot_.add_legend(fmt::format("{}, {}", curve.solver, curve.plan), curve.devices,
                         styles_[c]);
        for (const TrajectoryPoint& p : curve.points) plot_.include(p.time, p.distance);
    }
}

void TrajectoryPicture::draw(Canvas& canvas) const {
    plot_.draw_frame(canvas);
    plot_.draw_level(canvas, study_.doubt, "how far the reference is sure");
    for (std::size_t c = 0; c < styles_.size(); ++c) {
        draw_curve(canvas, study_.curves[c], styles_[c]);
    }
    draw_front(canvas);
}

void TrajectoryPicture::draw_curve(Canvas& canvas, const TrajectoryCurve& curve,
                                   CurveStyle style) const {
    std::vector<TrajectoryPoint> points;
    std::ranges::copy_if(curve.points, std::back_inserter(points), [](const TrajectoryPoint& p) {
        return LogPlot::has_place(p.time, p.distance);
    });
    std::ranges::sort(points, [](const TrajectoryPoint& a, const TrajectoryPoint& b) {
        return std::pair(a.substeps, a.iterations) < std::pair(b.substeps, b.iterations);
    });
    for (std::size_t k = 0; k < points.size(); ++k) {
        const TrajectoryPoint& p = points[k];
        const Point at = plot_.at(p.time, p.distance);
        if (k > 0 && points[k - 1].substeps == p.substeps) {
            const Point before = plot_.at(points[k - 1].time, points[k - 1].distance);
            plot_.draw_line(canvas, before, at, style, 0.7);
        }
        plot_.draw_mark(
            canvas, at, style,
            fmt::format("{} on {}, {}: {} x {}, {:.3g} s, {:.2e} m", curve.solver, curve.devices,
                        curve.plan, p.substeps, p.iterations, p.time, p.distance));
    }
}

void TrajectoryPicture::draw_front(Canvas& canvas) const {
    std::vector<TrajectoryPoint> front;
    for (const TrajectoryCurve& curve : study_.curves) {
        for (const TrajectoryPoint& p : curve.points) {
            if (p.on_front && LogPlot::has_place(p.time, p.distance)) front.push_back(p);
        }
    }
    std::ranges::sort(front, {}, &TrajectoryPoint::time);
    for (std::size_t k = 0; k < front.size(); ++k) {
        const Point at = plot_.at(front[k].time, front[k].distance);
        canvas.text({at.x + 5.0, at.y - 5.0},
                    fmt::format("{}x{}", front[k].substeps, front[k].iterations), 10.0,
                    Anchor::kStart, kInk);
        if (k == 0) continue;
        // Between two of its points, the faster one is the best that one can have.
        const Point before = plot_.at(front[k - 1].time, front[k - 1].distance);
        canvas.line(before, {at.x, before.y}, kInk, 1.5, false);
        canvas.line({at.x, before.y}, at, kInk, 1.5, false);
    }
}

}  // namespace weft
