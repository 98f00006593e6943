#include "apps/weft/pictures/stability_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace weft {

namespace {

using namespace stability;

// Lengths in pixels.
constexpr double kLeft = 90.0;
constexpr double kTop = 50.0;
constexpr double kPanel = 200.0;
constexpr double kGap = 18.0;
constexpr double kRowHeight = 300.0;
constexpr double kText = 12.0;

constexpr Colour kBlack{20, 20, 20};
constexpr Colour kWhite{255, 255, 255};

Colour colour_of(Verdict verdict) {
    switch (verdict) {
        case Verdict::kStable:
            return {0, 158, 115};
        case Verdict::kDissipated:
            return {86, 180, 233};
        case Verdict::kUnconverged:
            return {240, 228, 66};
        case Verdict::kExploded:
            return {213, 94, 0};
        case Verdict::kStopped:
            return {110, 110, 110};
    }
    return kBlack;
}

/// Where values are on an axis, in equal steps.
class Places {
public:
    Places(const std::vector<const Row*>& rows, double Case::*value) {
        for (const Row* row : rows) values_.insert(row->what.*value);
    }
    double step() const { return kPanel / static_cast<double>(values_.size()); }
    double at(double value) const {
        return step() * static_cast<double>(std::distance(values_.begin(), values_.find(value)));
    }
    const std::set<double>& values() const { return values_; }

private:
    std::set<double> values_;
};

std::string note_of(const Row& row) {
    const Outcome& o = row.outcome;
    std::string note = fmt::format("{}, {}: {}", o.solver, row.what.name, name_of(o.verdict));
    if (!o.why.empty()) note += "; " + o.why;
    return note + (o.is_silent() ? "; without a word" : "");
}

}  // namespace

StabilityPicture::StabilityPicture(const std::vector<Row>& rows) : rows_(rows) {
    for (const Row& row : rows) {
        if (std::ranges::find(solvers_, row.outcome.solver) == solvers_.end()) {
            solvers_.push_back(row.outcome.solver);
        }
    }
    for (const Map& map : all_maps()) {
        if (!rows_of(map.group).empty()) maps_.push_back(map);
    }
}

std::vector<const Row*> StabilityPicture::rows_of(const std::string& group) const {
    std::vector<const Row*> list;
    for (const Row& row : rows_) {
        if (row.what.group == group) list.push_back(&row);
    }
    return list;
}

double StabilityPicture::width() const {
    return kLeft + (kPanel + kGap) * static_cast<double>(std::max<std::size_t>(solvers_.size(), 3));
}

double StabilityPicture::height() const {
    return kTop + kRowHeight * static_cast<double>(maps_.size());
}

void StabilityPicture::draw(Canvas& canvas) const {
    canvas.rectangle({0, 0}, width(), height(), kWhite, "");
    draw_legend(canvas);
    double top = kTop;
    for (const Map& map : maps_) {
        draw_map(canvas, map, top);
        top += kRowHeight;
    }
}

void StabilityPicture::draw_legend(Canvas& canvas) const {
    double x = kLeft;
    for (const Verdict verdict : kVerdicts) {
        canvas.rectangle({x, 14.0}, kText, kText, colour_of(verdict), "");
        canvas.text({x + 1.5 * kText, 25.0}, name_of(verdict), kText, Anchor::kStart, kBlack);
        x += 110.0;
    }
    canvas.text({x, 25.0}, "x: without a word", kText, Anchor::kStart, kBlack);
}

void StabilityPicture::draw_map(Canvas& canvas, const Map& map, double top) const {
    canvas.text({kLeft, top + 14.0}, map.title, 1.1 * kText, Anchor::kStart, kBlack);
    canvas.text({8.0, top + 34.0}, map.up, 0.85 * kText, Anchor::kStart, kBlack);
    double x = kLeft;
    for (const std::string& solver : solvers_) {
        draw_panel(canvas, {map, solver, {x, top + 40.0}, solver == solvers_.front()});
        x += kPanel + kGap;
    }
}

void StabilityPicture::draw_panel(Canvas& canvas, const Panel& panel) const {
    const auto rows = rows_of(panel.map.group);
    const Places across(rows, &Case::across);
    const Places up(rows, &Case::up);
    const Point corner = panel.corner;
    const auto place = [&](const Case& what) {
        return Point{corner.x + across.at(what.across),
                     corner.y + kPanel - up.at(what.up) - up.step()};
    };
    for (const Row* row : rows) {
        if (row->outcome.solver != panel.solver) continue;
        const Point at = place(row->what);
        canvas.rectangle(at, across.step() - 1.0, up.step() - 1.0, colour_of(row->outcome.verdict),
                         note_of(*row));
        if (!row->outcome.is_silent()) continue;
        canvas.line(at, {at.x + across.step(), at.y + up.step()}, kBlack, 1.5, false);
        canvas.line({at.x + across.step(), at.y}, {at.x, at.y + up.step()}, kBlack, 1.5, false);
    }
    canvas.text({corner.x + 0.5 * kPanel, corner.y - 6.0}, panel.solver, kText, Anchor::kMiddle,
                kBlack);
    for (const double value : across.values()) {
        canvas.text({corner.x + across.at(value) + 0.5 * across.step(), corner.y + kPanel + 13.0},
                    fmt::format("{:.2g}", value), 0.75 * kText, Anchor::kMiddle, kBlack);
    }
    canvas.text({corner.x + 0.5 * kPanel, corner.y + kPanel + 28.0}, panel.map.across, 0.85 * kText,
                Anchor::kMiddle, kBlack);
    if (!panel.is_first) return;
    for (const double value : up.values()) {
        canvas.text({corner.x - 6.0, corner.y + kPanel - up.at(value) - 0.5 * up.step() + 4.0},
                    fmt::format("{:.3g}", value), 0.75 * kText, Anchor::kEnd, kBlack);
    }
}

}  // namespace weft
