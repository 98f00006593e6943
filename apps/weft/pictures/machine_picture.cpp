#include "apps/weft/pictures/machine_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace weft {

namespace {

// In pixels.
constexpr double kLeft = 60.0;
constexpr double kTop = 50.0;
constexpr double kGap = 18.0;
constexpr double kRowHeight = 300.0;

constexpr Colour kBlack{20, 20, 20};

Colour colour_of(Winner winner) {
    switch (winner) {
        case Winner::kSingle:
            return {153, 153, 153};
        case Winner::kExact:
            return {0, 158, 115};
        case Winner::kPlaced:
            return {86, 180, 233};
        case Winner::kAsync:
            return {213, 94, 0};
    }
    return kBlack;
}

std::string note_of(const MachineRow& row) {
    std::string note =
        fmt::format("{} devices, {:g} x, wait {:g} us:", row.devices, row.ratio, 1e6 * row.wait);
    for (const Winner w : kWinners) {
        note +=
            fmt::format(" {} {:.4g} ms,", name_of(w), 1e3 * row.time[static_cast<std::size_t>(w)]);
    }
    return note + fmt::format(" with window {} and {:.3g} times the iterations", row.window,
                              row.more_iterations);
}

}  // namespace

MachinePicture::MachinePicture(const MachineStudy& study) : study_(study) {
    for (const MachineRow& row : study.rows) {
        if (std::ranges::find(devices_, row.devices) == devices_.end()) {
            devices_.push_back(row.devices);
        }
    }
}

double MachinePicture::width() const {
    const auto panels = static_cast<double>(std::max<std::size_t>(devices_.size(), 3));
    return kLeft + (MapPanel::kSize + kGap) * panels;
}

double MachinePicture::height() const {
    return kTop + kRowHeight * static_cast<double>(kFasterAt.size());
}

void MachinePicture::draw(Canvas& canvas) const {
    canvas.rectangle({0, 0}, width(), height(), {255, 255, 255}, "");
    std::vector<std::pair<std::string, Colour>> key;
    for (const Winner winner : kWinners) key.emplace_back(name_of(winner), colour_of(winner));
    draw_colour_key(canvas, kLeft, key);
    double top = kTop;
    for (const FasterAt faster : kFasterAt) {
        const std::string at =
            faster == FasterAt::kEverything ? "everything" : '"' + study_.fast_kind + '"';
        canvas.text(
            {kLeft, top + 14.0},
            fmt::format("{}: every second device is so many times faster at {}", study_.scene, at),
            1.1 * MapPanel::kText, Anchor::kStart, kBlack);
        double left = kLeft;
        for (const int devices : devices_) {
            panel_of(faster, devices).draw(canvas, {left, top + 40.0});
            left += MapPanel::kSize + kGap;
        }
        top += kRowHeight;
    }
}

MapPanel MachinePicture::panel_of(FasterAt faster, int devices) const {
    MapPanel panel{
        fmt::format("{} devices", devices), "wait [us]", devices == devices_.front(), {}};
    for (const MachineRow& row : study_.rows) {
        if (row.faster != faster || row.devices != devices) continue;
        panel.cells.push_back(
            {1e6 * row.wait, row.ratio, colour_of(row.winner()), note_of(row), false});
    }
    return panel;
}

}  // namespace weft
