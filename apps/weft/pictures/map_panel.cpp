#include "apps/weft/pictures/map_panel.h"

#include <fmt/format.h>

#include <iterator>
#include <utility>

namespace weft {

namespace {

constexpr Colour kBlack{20, 20, 20};

/// Two figures; thousands are not to be powers of ten for that.
std::string label_of(double value) {
    return value < 99.5 ? fmt::format("{:.2g}", value) : fmt::format("{:.4g}", value);
}

/// Where values are on an axis, in equal steps.
class Places {
public:
    Places(const std::vector<MapPanel::Cell>& cells, double MapPanel::Cell::*value) {
        for (const MapPanel::Cell& cell : cells) values_.insert(cell.*value);
    }
    double step() const { return MapPanel::kSize / static_cast<double>(values_.size()); }
    double at(double value) const {
        return step() * static_cast<double>(std::distance(values_.begin(), values_.find(value)));
    }
    const std::set<double>& values() const { return values_; }

private:
    std::set<double> values_;
};

}  // namespace

void MapPanel::draw(Canvas& canvas, Point corner) const {
    const Places right(cells, &Cell::across);
    const Places high(cells, &Cell::up);
    for (const Cell& cell : cells) {
        const Point at{corner.x + right.at(cell.across),
                       corner.y + kSize - high.at(cell.up) - high.step()};
        canvas.rectangle(at, right.step() - 1.0, high.step() - 1.0, cell.colour, cell.note);
        if (!cell.is_crossed_out) continue;
        const Point end{at.x + right.step(), at.y + high.step()};
        canvas.line(at, end, kBlack, 1.5, false);
        canvas.line({end.x, at.y}, {at.x, end.y}, kBlack, 1.5, false);
    }
    canvas.text({corner.x + 0.5 * kSize, corner.y - 6.0}, title, kText, Anchor::kMiddle, kBlack);
    for (const double value : right.values()) {
        canvas.text({corner.x + right.at(value) + 0.5 * right.step(), corner.y + kSize + 13.0},
                    label_of(value), 0.75 * kText, Anchor::kMiddle, kBlack);
    }
    canvas.text({corner.x + 0.5 * kSize, corner.y + kSize + 28.0}, across, 0.85 * kText,
                Anchor::kMiddle, kBlack);
    if (!has_labels) return;
    for (const double value : high.values()) {
        canvas.text({corner.x - 6.0, corner.y + kSize - high.at(value) - 0.5 * high.step() + 4.0},
                    fmt::format("{:.3g}", value), 0.75 * kText, Anchor::kEnd, kBlack);
    }
}

double draw_colour_key(Canvas& canvas, double left,
                       const std::vector<std::pair<std::string, Colour>>& key) {
    constexpr double kColumn = 110.0;
    for (const auto& [name, colour] : key) {
        canvas.rectangle({left, 14.0}, MapPanel::kText, MapPanel::kText, colour, "");
        canvas.text({left + 1.5 * MapPanel::kText, 25.0}, name, MapPanel::kText, Anchor::kStart,
                    kBlack);
        left += kColumn;
    }
    return left;
}

}  // namespace weft
