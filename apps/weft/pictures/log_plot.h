#pragma once

#include <string>
#include <vector>

#include "apps/weft/pictures/canvas.h"

namespace weft {

/// How a curve looks: its colour says one thing, its line and marks another.
struct CurveStyle {
    std::size_t colour = 0;  ///< a number; neighbouring ones can be told apart by everybody
    std::size_t line = 0;    ///< solid or dashed, with squares or triangles
};

/// The number of `name` among those seen so far, which it joins.
std::size_t number_of(std::vector<std::string>& seen, const std::string& name);

/// Colours by solver, lines by devices and plan; where all are one solver's, colours by these, too.
template <class Curve>
std::vector<CurveStyle> curve_styles(const std::vector<Curve>& curves) {
    std::vector<std::string> solvers, lists;
    std::vector<CurveStyle> styles;
    for (const Curve& curve : curves) {
        const std::size_t colour = number_of(solvers, curve.solver);
        styles.push_back({colour, number_of(lists, curve.devices + ' ' + curve.plan)});
    }
    if (solvers.size() > 1) return styles;
    for (CurveStyle& style : styles) style.colour = style.line;
    return styles;
}

/// Axes with logarithmic scales, a legend, and the places of points between them. A point that has
/// no logarithm has no place: see has_place().
class LogPlot {
public:
    LogPlot(std::string title, std::string x_label, std::string y_label);

    // First, what the plot is to hold.
    static bool has_place(double x, double y);
    void include(double x, double y);  ///< does nothing for a point without a place
    void add_legend(std::string name, std::string detail, CurveStyle style);

    double width() const;
    double height() const;
    /// For plots side by side.
    void set_height_of(const LogPlot& other) { least_height_ = other.bottom(); }

    // Then, drawing.
    void draw_frame(Canvas& canvas) const;
    Point at(double x, double y) const;
    Point left_at(double y) const;  ///< on the left border
    void draw_line(Canvas& canvas, Point from, Point to, CurveStyle style, double width) const;
    void draw_mark(Canvas& canvas, Point at, CurveStyle style, const std::string& note) const;
    /// A dashed line across, with its name.
    void draw_level(Canvas& canvas, double y, const std::string& name) const;

private:
    /// A scale over powers of ten. Empty until something is included.
    struct Scale {
        double least = 0.0;
        double most = 0.0;

        void include(double value);
        int low() const;
        int high() const;
        double share(double value) const;
        /// Where lines are: powers of ten, and 2 and 5 times these where there are few.
        std::vector<double> ticks() const;
    };
    struct Entry {
        std::string name, detail;
        CurveStyle style;
    };

    double bottom() const;
    void draw_legend(Canvas& canvas) const;

    std::string title_, x_label_, y_label_;
    Scale x_, y_;
    std::vector<Entry> legend_;
    double least_height_ = 0.0;
};

}  // namespace weft
