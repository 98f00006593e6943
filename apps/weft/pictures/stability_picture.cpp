#include "apps/weft/pictures/stability_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace weft {

namespace {

using namespace stability;

// Lengths in pixels.
constexpr double kLeft = 90.0;
constexpr double kTop = 50.0;
constexpr double kPanel = MapPanel::kSize;
constexpr double kGap = 18.0;
constexpr double kRowHeight = 300.0;
constexpr double kText = MapPanel::kText;

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
    std::vector<std::pair<std::string, Colour>> key;
    for (const Verdict verdict : kVerdicts) key.emplace_back(name_of(verdict), colour_of(verdict));
    const double x = draw_colour_key(canvas, kLeft, key);
    canvas.text({x, 25.0}, "x: without a word", kText, Anchor::kStart, kBlack);
}

void StabilityPicture::draw_map(Canvas& canvas, const Map& map, double top) const {
    canvas.text({kLeft, top + 14.0}, map.title, 1.1 * kText, Anchor::kStart, kBlack);
    canvas.text({8.0, top + 34.0}, map.up, 0.85 * kText, Anchor::kStart, kBlack);
    double x = kLeft;
    for (const std::string& solver : solvers_) {
        panel_of(map, solver).draw(canvas, {x, top + 40.0});
        x += kPanel + kGap;
    }
}

MapPanel StabilityPicture::panel_of(const Map& map, const std::string& solver) const {
    MapPanel panel{solver, map.across, solver == solvers_.front(), {}};
    for (const Row* row : rows_of(map.group)) {
        if (row->outcome.solver != solver) continue;
        panel.cells.push_back({row->what.across, row->what.up, colour_of(row->outcome.verdict),
                               note_of(*row), row->outcome.is_silent()});
    }
    return panel;
}

}  // namespace weft
