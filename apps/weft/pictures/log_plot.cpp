#include "apps/weft/pictures/log_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weft {

namespace {

constexpr Colour kInk{40, 40, 40};
constexpr Colour kGrey{120, 120, 120};
constexpr Colour kGrid{226, 226, 226};
// Told apart by most eyes, printed too (Okabe and Ito).
constexpr Colour kColours[] = {{0, 114, 178},   {213, 94, 0},  {0, 158, 115},
                               {204, 121, 167}, {230, 159, 0}, {86, 180, 233}};

// In pixels.
constexpr double kLeft = 84.0;
constexpr double kRight = 664.0;
constexpr double kTop = 48.0;
constexpr double kPlotHeight = 460.0;
constexpr double kBelow = 60.0;
constexpr double kLegendLeft = kRight + 18.0;
constexpr double kLegendText = kLegendLeft + 34.0;
constexpr double kLegendRow = 36.0;
constexpr double kLetter = 0.62;  // of the font's size

Colour colour_of(CurveStyle style) { return kColours[style.colour % std::size(kColours)]; }

std::string number(double value) {
    return value >= 1e-3 && value < 1e4 ? fmt::format("{:g}", value) : fmt::format("{:.0e}", value);
}

}  // namespace

std::size_t number_of(std::vector<std::string>& seen, const std::string& name) {
    const auto at = std::find(seen.begin(), seen.end(), name);
    const auto number = static_cast<std::size_t>(at - seen.begin());
    if (at == seen.end()) seen.push_back(name);
    return number;
}

void LogPlot::Scale::include(double value) {
    least = least == 0.0 ? value : std::min(least, value);
    most = std::max(most, value);
}

int LogPlot::Scale::low() const {
    return least == 0.0 ? -1 : static_cast<int>(std::floor(std::log10(least)));
}

int LogPlot::Scale::high() const {
    return most == 0.0 ? 0 : std::max(low() + 1, static_cast<int>(std::ceil(std::log10(most))));
}

double LogPlot::Scale::share(double value) const {
    return (std::log10(value) - low()) / (high() - low());
}

std::vector<double> LogPlot::Scale::ticks() const {
    constexpr int kFewDecades = 3;
    constexpr int kMostTicks = 12;
    const int decades = high() - low();
    const int every = 1 + decades / kMostTicks;
    std::vector<double> list;
    for (int d = low(); d <= high(); d += every) {
        list.push_back(std::pow(10.0, d));
        if (decades > kFewDecades || d == high()) continue;
        for (const double factor : {2.0, 5.0}) list.push_back(factor * std::pow(10.0, d));
    }
    return list;
}

LogPlot::LogPlot(std::string title, std::string x_label, std::string y_label)
    : title_(std::move(title)), x_label_(std::move(x_label)), y_label_(std::move(y_label)) {}

bool LogPlot::has_place(double x, double y) {
    return x > 0.0 && y > 0.0 && std::isfinite(x) && std::isfinite(y);
}

void LogPlot::include(double x, double y) {
    if (!has_place(x, y)) return;
    x_.include(x);
    y_.include(y);
}

void LogPlot::add_legend(std::string name, std::string detail, CurveStyle style) {
    legend_.push_back({std::move(name), std::move(detail), style});
}

double LogPlot::width() const {
    constexpr double kLeast = 120.0;
    double text = kLeast;
    for (const Entry& entry : legend_) {
        const std::size_t letters = std::max(entry.name.size(), entry.detail.size());
        text = std::max(text, 12.0 * kLetter * static_cast<double>(letters));
    }
    return kLegendText + text + 16.0;
}

double LogPlot::bottom() const {
    const double legend = kLegendRow * static_cast<double>(legend_.size());
    return std::max(kTop + std::max(kPlotHeight, legend), least_height_);
}

double LogPlot::height() const { return bottom() + kBelow; }

Point LogPlot::at(double x, double y) const {
    return {kLeft + x_.share(x) * (kRight - kLeft), bottom() - y_.share(y) * (bottom() - kTop)};
}

Point LogPlot::left_at(double y) const { return {kLeft, at(1.0, y).y}; }

void LogPlot::draw_frame(Canvas& canvas) const {
    for (const double tick : x_.ticks()) {
        const double x = at(tick, 1.0).x;
        canvas.line({x, kTop}, {x, bottom()}, kGrid, 1.0, false);
        canvas.text({x, bottom() + 18.0}, number(tick), 12.0, Anchor::kMiddle, kInk);
    }
    for (const double tick : y_.ticks()) {
        const double y = at(1.0, tick).y;
        canvas.line({kLeft, y}, {kRight, y}, kGrid, 1.0, false);
        canvas.text({kLeft - 8.0, y + 4.0}, number(tick), 12.0, Anchor::kEnd, kInk);
    }
    canvas.line({kLeft, bottom()}, {kRight, bottom()}, kInk, 1.0, false);
    canvas.line({kLeft, kTop}, {kLeft, bottom()}, kInk, 1.0, false);
    canvas.text({(kLeft + kRight) / 2.0, bottom() + 44.0}, x_label_, 14.0, Anchor::kMiddle, kInk);
    canvas.text({14.0, 18.0}, title_, 14.0, Anchor::kStart, kInk);
    canvas.text({14.0, 38.0}, y_label_, 13.0, Anchor::kStart, kGrey);
    draw_legend(canvas);
}

void LogPlot::draw_legend(Canvas& canvas) const {
    double row = kTop + 14.0;
    for (const Entry& entry : legend_) {
        const double middle = kLegendLeft + 13.0;
        draw_line(canvas, {kLegendLeft, row}, {kLegendLeft + 26.0, row}, entry.style, 2.0);
        draw_mark(canvas, {middle, row}, entry.style, "");
        canvas.text({kLegendText, row + 4.0}, entry.name, 12.0, Anchor::kStart, kInk);
        canvas.text({kLegendText, row + 18.0}, entry.detail, 11.0, Anchor::kStart, kGrey);
        row += kLegendRow;
    }
}

void LogPlot::draw_line(Canvas& canvas, Point from, Point to, CurveStyle style,
                        double width) const {
    canvas.line(from, to, colour_of(style), width, style.line % 2 == 1);
}

void LogPlot::draw_mark(Canvas& canvas, Point at, CurveStyle style, const std::string& note) const {
    constexpr double kSize = 2.5;
    if (style.line / 2 % 2 == 1) {
        canvas.triangle({Point{at.x, at.y - 2.0 * kSize}, Point{at.x - 1.6 * kSize, at.y + kSize},
                         Point{at.x + 1.6 * kSize, at.y + kSize}},
                        colour_of(style));
    }
    const double half = style.line / 2 % 2 == 1 ? 0.5 * kSize : kSize;
    canvas.rectangle({at.x - half, at.y - half}, 2.0 * half, 2.0 * half, colour_of(style), note);
}

void LogPlot::draw_level(Canvas& canvas, double y, const std::string& name) const {
    if (!(y > 0.0) || y_.share(y) < 0.0 || y_.share(y) > 1.0) return;
    const double height = at(1.0, y).y;
    canvas.line({kLeft, height}, {kRight, height}, kGrey, 1.0, true);
    canvas.text({kLeft + 6.0, height - 4.0}, name, 11.0, Anchor::kStart, kGrey);
}

}  // namespace weft
