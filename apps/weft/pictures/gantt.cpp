#include "apps/weft/pictures/gantt.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/weft/trace/recorded_frames.h"
#include "runtime/error.h"
#include "runtime/trace/recorded_graph.h"

namespace weft {

namespace {

// Lengths in pixels.
constexpr double kWidth = 1400.0;
constexpr double kLeft = 130.0;
constexpr double kRight = 30.0;
constexpr double kTitleHeight = 40.0;
constexpr double kPanelTitle = 26.0;
constexpr double kRow = 54.0;
constexpr double kBar = 34.0;
constexpr double kAxisHeight = 34.0;
constexpr double kLegendHeight = 30.0;
constexpr double kArrowHead = 6.0;
constexpr double kLetter = 0.6;  // of the font size

constexpr Colour kBlack{20, 20, 20};
constexpr Colour kGrey{110, 110, 110};
constexpr Colour kLightGrey{225, 225, 225};

/// Okabe and Ito's, which everybody can tell apart.
constexpr Colour kKinds[] = {{86, 180, 233}, {230, 159, 0}, {0, 158, 115}, {204, 121, 167},
                             {240, 228, 66}, {0, 114, 178}, {213, 94, 0},  {153, 153, 153}};

/// Of arrows, by the device that they go to: green and red as in the paper's figures 10 to 13.
constexpr Colour kTargets[] = {{0, 130, 60}, {200, 30, 30}, {40, 70, 190}, {130, 60, 150}};

template <std::size_t N>
Colour pick(const Colour (&list)[N], std::size_t index) {
    return list[index % N];
}

/// Iterations alternate, so that they can be told apart.
Colour colour_of(const PlanRecord& task) {
    const Colour c = pick(kKinds, task.kind);
    if (task.iteration % 2 == 0) return c;
    const auto lighter = [](std::uint8_t v) {
        return static_cast<std::uint8_t>(v + (255 - v) / 3);
    };
    return {lighter(c.red), lighter(c.green), lighter(c.blue)};
}

std::string milliseconds(double seconds) { return fmt::format("{:.3f} ms", 1e3 * seconds); }

/// 1, 2 or 5 times a power of ten, about ten of them in `length`.
double tick_step(double length) {
    const double raw = length / 10.0;
    const double power = std::pow(10.0, std::floor(std::log10(raw)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * power >= raw) return factor * power;
    }
    return 10.0 * power;
}

}  // namespace

Gantt::Gantt(const RunDescription& run, const FrameRecord& frame, const GanttPart& part)
    : run_(run), frame_(frame), part_(part), tasks_(tasks_in_order(run, frame)) {
    const std::uint32_t count = substeps_of(frame);
    if (part.substep >= count) {
        throw UserError(fmt::format("frame {} has no substep {}; it has 0 to {}", frame.frame,
                                    part.substep, static_cast<long>(count) - 1));
    }
    std::uint32_t last = 0;
    for (const PlanRecord& task : tasks_) last = std::max(last, task.iteration);
    if (part.iterations && part.iterations->second > last) {
        throw UserError(fmt::format("frame {} has no iteration {}; it has 0 to {}", frame.frame,
                                    part.iterations->second, last));
    }
    find_planned();
    find_measured();
    end_ = std::max({planned_.end, measured_.end, 1e-9});
    const double panel_height =
        kPanelTitle + kRow * static_cast<double>(run.devices.size()) + kAxisHeight;
    planned_.top = kTitleHeight;
    measured_.top = kTitleHeight + panel_height;
}

bool Gantt::shows(const PlanRecord& task) const {
    if (!part_.iterations) return true;
    return part_.iterations->first <= task.iteration && task.iteration <= part_.iterations->second;
}

/// Its first bar does; what lies before it is not drawn.
void Gantt::start_at_zero(Panel& panel) const {
    double begin = std::numeric_limits<double>::infinity();
    for (const Bar& bar : panel.bars) {
        if (bar.is_shown) begin = std::min(begin, bar.start);
    }
    if (!std::isfinite(begin)) return;
    for (Bar& bar : panel.bars) {
        bar.start -= begin;
        bar.end -= begin;
        if (bar.is_shown) panel.end = std::max(panel.end, bar.end);
    }
    for (Copy& copy : panel.copies) {
        copy.start -= begin;
        copy.end -= begin;
    }
    if (!part_.iterations) return;
    std::erase_if(panel.copies, [&](const Copy& c) { return c.start < 0.0 || c.end > panel.end; });
}

void Gantt::find_planned() {
    for (const PlanRecord& task : tasks_) {
        planned_.bars.push_back(
            {&task, task.device, frame_.pace * task.start, frame_.pace * task.end, shows(task)});
    }
    start_at_zero(planned_);
    planned_.title = "planned: " + milliseconds(planned_.end);
}

void Gantt::find_measured() {
    measured_.bars.resize(tasks_.size());
    for (const ExecutionRecord& e : frame_.executions) {
        if (e.substep != part_.substep) continue;
        if (e.task >= tasks_.size() || e.device >= run_.devices.size()) {
            throw UserError(fmt::format("frame {}: its executions are damaged", frame_.frame));
        }
        const PlanRecord& task = tasks_[e.task];
        measured_.bars[e.task] = {&task, e.device, e.start, e.end, shows(task)};
    }
    for (const TransferRecord& t : frame_.transfers) {
        if (t.substep != part_.substep || t.from >= run_.devices.size() ||
            t.to >= run_.devices.size()) {
            continue;
        }
        measured_.copies.push_back({&t, t.start, t.end});
    }
    start_at_zero(measured_);
    measured_.title = fmt::format(
        "measured: {} from the first start to the last end; {} per substep",
        milliseconds(measured_.end), milliseconds(frame_.measured_makespan / substeps_of(frame_)));
}

std::string Gantt::title() const {
    std::string text =
        fmt::format("{}: frame {}, substep {}", run_.scene_name, frame_.frame, part_.substep);
    if (!part_.iterations) return text;
    const auto [first, last] = *part_.iterations;
    if (first == last) return text + fmt::format(", iteration {}", first);
    return text + fmt::format(", iterations {} to {}", first, last);
}

double Gantt::width() const { return kWidth; }

double Gantt::height() const { return 2.0 * measured_.top - kTitleHeight + kLegendHeight; }

double Gantt::x_of(double time) const {
    return kLeft + (kWidth - kLeft - kRight) * std::max(time, 0.0) / end_;
}

double Gantt::row_top(const Panel& panel, std::uint32_t device) const {
    return panel.top + kPanelTitle + kRow * device + 0.5 * (kRow - kBar);
}

void Gantt::draw(Canvas& canvas) const {
    canvas.text({0.5 * kWidth, 24.0}, title(), 16.0, Anchor::kMiddle, kBlack);
    for (const Panel* panel : {&planned_, &measured_}) {
        draw_axis(canvas, *panel);
        draw_devices(canvas, *panel);
        draw_bars(canvas, *panel);
        draw_dependencies(canvas, *panel);
        draw_copies(canvas, *panel);
    }
    draw_legend(canvas);
}

void Gantt::draw_axis(Canvas& canvas, const Panel& panel) const {
    const double top = panel.top + kPanelTitle;
    const double bottom = top + kRow * static_cast<double>(run_.devices.size());
    const bool in_ms = end_ >= 2e-3;
    const double step = tick_step(end_);
    for (int i = 0; i * step <= end_; ++i) {
        const double x = x_of(i * step);
        canvas.line({x, top}, {x, bottom}, kLightGrey, 1.0, false);
        canvas.text({x, bottom + 14.0}, fmt::format("{:.6g}", (in_ms ? 1e3 : 1e6) * i * step), 11.0,
                    Anchor::kMiddle, kGrey);
    }
    canvas.text({kLeft - 14.0, bottom + 14.0}, in_ms ? "ms" : "us", 11.0, Anchor::kEnd, kGrey);
    const double end = x_of(panel.end);
    canvas.line({end, top}, {end, bottom}, kGrey, 1.2, true);
    canvas.text({kLeft, panel.top + 18.0}, panel.title, 13.0, Anchor::kStart, kBlack);
}

void Gantt::draw_devices(Canvas& canvas, const Panel& panel) const {
    for (std::uint32_t d = 0; d < run_.devices.size(); ++d) {
        const double middle = row_top(panel, d) + 0.5 * kBar;
        canvas.text({kLeft - 14.0, middle + 4.0}, short_device_name(run_, d), 13.0, Anchor::kEnd,
                    kBlack);
        canvas.line({kLeft, middle}, {kWidth - kRight, middle}, kLightGrey, 1.0, false);
    }
}

void Gantt::draw_bars(Canvas& canvas, const Panel& panel) const {
    constexpr double kGap = 0.8;  // between neighbours, where they are wide enough for one
    constexpr double kFont = 10.0;
    for (const Bar& bar : panel.bars) {
        if (!bar.is_shown) continue;
        const double left = x_of(bar.start);
        const double full = x_of(bar.end) - left;
        const double width = full > 4.0 * kGap ? full - kGap : std::max(full, 0.3);
        const double top = row_top(panel, bar.device);
        const std::string name = task_name(run_, *bar.task);
        canvas.rectangle({left, top}, width, kBar, colour_of(*bar.task),
                         fmt::format("{}: {} items, {:.1f} to {:.1f} us", name, bar.task->items,
                                     1e6 * bar.start, 1e6 * bar.end));
        const std::string label =
            fmt::format("{}.{}", run_.kinds[bar.task->kind], bar.task->iteration);
        if (kLetter * kFont * static_cast<double>(label.size()) > width) continue;
        canvas.text({left + 0.5 * width, top + 0.5 * kBar + 3.5}, label, kFont, Anchor::kMiddle,
                    kBlack);
    }
}

/// What comes from before the iterations that are drawn begins at the border.
void Gantt::draw_dependencies(Canvas& canvas, const Panel& panel) const {
    if (!frame_.graph) return;
    for (const DependencyRecord& d : frame_.graph->dependencies) {
        if (d.carried != 0 || std::max(d.from, d.to) >= panel.bars.size()) continue;
        const Bar& from = panel.bars[d.from];
        const Bar& to = panel.bars[d.to];
        if (from.task == nullptr || !to.is_shown || from.device == to.device) continue;
        draw_arrow_between(canvas, panel, from.device, from.end, to.device, to.start,
                           pick(kTargets, to.device), false);
    }
}

void Gantt::draw_copies(Canvas& canvas, const Panel& panel) const {
    for (const Copy& copy : panel.copies) {
        draw_arrow_between(canvas, panel, copy.record->from, copy.start, copy.record->to, copy.end,
                           kBlack, true);
    }
}

/// From the edge of one device's bars to that of another's.
void Gantt::draw_arrow_between(Canvas& canvas, const Panel& panel, std::uint32_t from_device,
                               double from, std::uint32_t to_device, double to, Colour colour,
                               bool dashed) const {
    const bool down = to_device > from_device;
    draw_arrow(canvas, {x_of(from), row_top(panel, from_device) + (down ? kBar : 0.0)},
               {x_of(to), row_top(panel, to_device) + (down ? 0.0 : kBar)}, colour, dashed);
}

void Gantt::draw_arrow(Canvas& canvas, Point from, Point to, Colour colour, bool dashed) const {
    const double dx = to.x - from.x;
    const double dy = to.y - from.y;
    const double length = std::max(std::hypot(dx, dy), 1.0);
    const Point along{dx / length * kArrowHead, dy / length * kArrowHead};
    const Point base{to.x - along.x, to.y - along.y};
    canvas.line(from, base, colour, 1.2, dashed);
    canvas.triangle({to, Point{base.x - 0.4 * along.y, base.y + 0.4 * along.x},
                     Point{base.x + 0.4 * along.y, base.y - 0.4 * along.x}},
                    colour);
}

void Gantt::draw_legend(Canvas& canvas) const {
    constexpr double kFont = 12.0;
    const double y = height() - 12.0;
    double x = kLeft;
    const auto label = [&](const std::string& text) {
        canvas.text({x, y}, text, kFont, Anchor::kStart, kBlack);
        x += kLetter * kFont * static_cast<double>(text.size()) + 22.0;
    };
    std::vector<bool> used(run_.kinds.size(), false);
    for (const PlanRecord& task : tasks_) {
        if (shows(task)) used[task.kind] = true;
    }
    for (std::size_t kind = 0; kind < used.size(); ++kind) {
        if (!used[kind]) continue;
        canvas.rectangle({x, y - 10.0}, 12.0, 12.0, pick(kKinds, kind), "");
        x += 18.0;
        label(run_.kinds[kind]);
    }
    const auto arrow = [&](Colour colour, bool dashed, const std::string& text) {
        draw_arrow(canvas, {x, y - 4.0}, {x + 30.0, y - 4.0}, colour, dashed);
        x += 36.0;
        label(text);
    };
    if (run_.devices.size() < 2) return;
    for (std::uint32_t d = 0; d < run_.devices.size(); ++d) {
        arrow(pick(kTargets, d), false, fmt::format("needed by {}", short_device_name(run_, d)));
    }
    if (!measured_.copies.empty()) arrow(kBlack, true, "copy");
}

}  // namespace weft
