#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/executor.h"
#include "runtime/load_meter.h"
#include "runtime/planning/frame_planner.h"
#include "runtime/planning/frame_recorder.h"

namespace weft {

/// A device that failed in mid-run and was left out from there on.
struct LostDevice {
    int device = 0;  ///< its number in the run's list
    int frame = 0;
    std::string why;
};

struct PlanningOptions {
    PlanKind plan = PlanKind::kAuto;
    std::optional<Division> division;  ///< fixed instead of planned
    std::filesystem::path cost_file;   ///< where costs are kept between runs; empty: nowhere
    bool strict_math = true;           ///< that the devices were opened with: costs depend on it
};

/// Devices with all that plans and runs work on them: an executor, a planner, what both have
/// learnt, and what becomes of these when a device is lost. What a frame is made of, and how to get
/// back to its start, is the caller's business.
class PlannedExecutor {
public:
    PlannedExecutor(StepMaker& maker, int strip_count, std::vector<std::unique_ptr<Device>> devices,
                    PlanningOptions options);

    /// Goes on with other work, whose first kinds are the same; their costs stay. The one before
    /// must still be there.
    void take_over(StepMaker& maker, int strip_count);
    /// The same, by another kind of plan.
    void take_over(StepMaker& maker, int strip_count, PlanKind plan);
    /// The division that asynchronous plans have here: by units, of the first team.
    Division division_by_units() const;

    /// Starts from what earlier runs have learnt. Whether all was known.
    bool restore_costs();
    /// Keeps what was learnt for later runs, after so many frames; not what was learnt while others
    /// kept the cores busy.
    void save_costs(int frames);

    /// Profiles every device on the work's own tasks, `instances` of a step each.
    /// costs_known  from earlier runs: a first guess, since the machine may have been busy then
    /// undo         called after each, to take back what it did
    void calibrate(int instances, bool costs_known, const std::function<void()>& undo,
                   std::vector<std::string>& warnings);

    /// The plan for the next frame.
    const FramePlan& next() { return planner_->next(); }
    /// What was run of a frame so far.
    struct Beginning {
        RunTimes times;
        int instances = 0;
    };
    /// Runs as many instances of a frame of `instances` as it takes to see whether its plan is a
    /// mistake: none by a plan that has been seen at work, or in short frames. Without a value it
    /// is one, and the frame has to begin again, by the next() plan.
    std::optional<Beginning> try_out(const FramePlan& plan, int instances);
    /// Learns from how frame number `frame` went by it.
    void learn(const FramePlan& plan, const RunTimes& times, int instances, int frame);
    /// Writes down how it was planned and how it went, before anything is learnt from it.
    /// tasks  each of them, too
    void record(const FramePlan& plan, const RunTimes& times, int instances, bool tasks,
                FrameRecord& frame);

    /// Lets tables grow in which rows had no room. Says whether there were any: then what has been
    /// computed is of no use.
    bool make_room();
    /// Entries of tables are as at the beginning: those of a frame that went wrong may be no
    /// numbers. Between frames.
    void forget_entries();
    /// Lets tables grow whose rows had little room left, so that the frame to come need not be run
    /// twice. Between frames.
    void make_room_ahead();

    /// From now on without the device that was lost; what the host has is current. Throws RunError
    /// if there is no other.
    void go_on_without(const DeviceLost& lost, int frame);
    const std::vector<LostDevice>& losses() const { return losses_; }

    Executor& executor() { return *executor_; }
    const Executor& executor() const { return *executor_; }
    const FramePlanner& planner() const { return *planner_; }
    /// All that there ever were.
    const std::vector<std::unique_ptr<Device>>& devices() const { return devices_; }

private:
    std::vector<Device*> active_devices() const;
    void open();
    /// The one that was asked for, or the one that asynchronous plans have.
    std::optional<Division> fixed_division() const;
    void look_at_load(int frame);
    void note_limits(const FramePlan& plan, const RunTimes& times, double threads,
                     std::vector<std::string>& warnings) const;

    StepMaker* maker_;
    int strip_count_;
    std::vector<std::unique_ptr<Device>> devices_;
    PlanningOptions options_;
    /// Numbers of those that are still there: the executor's and the planner's devices.
    std::vector<int> active_;
    std::vector<LostDevice> losses_;
    std::unique_ptr<Executor> executor_;
    std::unique_ptr<FramePlanner> planner_;
    FrameRecorder recorder_;
    LoadMeter load_;
    int disturbed_frame_ = -1;  ///< the last one that others were seen to disturb; -1: none
};

/// Lets tables grow in which rows had no room in what the executor ran last; whether there were
/// any.
/// tables  in the order in which they are filled
bool grow_tables(const std::vector<RowTable*>& tables, Executor& executor);

}  // namespace weft
