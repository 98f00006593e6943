#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/weft/pictures/canvas.h"
#include "runtime/trace/records.h"

namespace weft {

/// What a schedule is drawn of.
struct GanttPart {
    std::uint32_t substep = 0;
    /// The first and the last of those that are drawn; null: all, and what is outside of them.
    std::optional<std::pair<std::uint32_t, std::uint32_t>> iterations;
};

/// Draws one substep of a frame, or some of its iterations: tasks by device, as planned above and
/// as it ran below, on one time axis; arrows where a device needs what another one made, and for
/// copies between memories.
class Gantt {
public:
    /// Throws UserError if the frame has no such part, or its records are damaged.
    Gantt(const RunDescription& run, const FrameRecord& frame, const GanttPart& part);

    double width() const;
    double height() const;
    void draw(Canvas& canvas) const;

private:
    /// A task on a device; times since the panel's start [s].
    struct Bar {
        const PlanRecord* task = nullptr;
        std::uint32_t device = 0;
        double start = 0.0;
        double end = 0.0;
        bool is_shown = false;
    };
    struct Copy {
        const TransferRecord* record = nullptr;
        double start = 0.0;
        double end = 0.0;
    };
    struct Panel {
        std::string title;
        std::vector<Bar> bars;  ///< by task number; without a task where it did not run
        std::vector<Copy> copies;
        double end = 0.0;
        double top = 0.0;  ///< [pixels]
    };

    bool shows(const PlanRecord& task) const;
    void find_planned();
    void find_measured();
    void start_at_zero(Panel& panel) const;
    std::string title() const;
    double x_of(double time) const;
    double row_top(const Panel& panel, std::uint32_t device) const;

    void draw_axis(Canvas& canvas, const Panel& panel) const;
    void draw_devices(Canvas& canvas, const Panel& panel) const;
    void draw_bars(Canvas& canvas, const Panel& panel) const;
    void draw_dependencies(Canvas& canvas, const Panel& panel) const;
    void draw_copies(Canvas& canvas, const Panel& panel) const;
    void draw_legend(Canvas& canvas) const;
    void draw_arrow(Canvas& canvas, Point from, Point to, Colour colour, bool dashed) const;
    void draw_arrow_between(Canvas& canvas, const Panel& panel, std::uint32_t from_device,
                            double from, std::uint32_t to_device, double to, Colour colour,
                            bool dashed) const;

    const RunDescription& run_;
    const FrameRecord& frame_;
    GanttPart part_;
    std::vector<PlanRecord> tasks_;
    Panel planned_, measured_;
    double end_ = 0.0;  ///< of the time axis
};

}  // namespace weft
