// What the log keeps of a plan is enough to make the same plan again.

#include "runtime/planning/plan_log.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "runtime/trace/recorded_graph.h"
#include "scheduler/planner.h"
#include "simulation/scene/read_scene.h"
#include "simulation/solver/solver.h"
#include "tests/runtime/planning/virtual_machine.h"

namespace weft::test {
namespace {

constexpr int kSubsteps = 4;

class PlanLogTest : public testing::Test {
protected:
    PlanLogTest()
        : model_(parse_scene(R"(
[scene]
frames = 1
dt = 0.016
[[cloth]]
grid = { size = [1.0, 1.0], resolution = [40, 160] }
density = 0.2
stretch = { stiffness = 1.0e4 }
bend = { stiffness = 1.0e-4 }
)",
                             "test.toml"),
                 warnings_),
          solver_(make_solver(model_)) {}

    /// Plans frames on such devices, and compares each with what comes out of its record.
    /// numbers  of the devices, among `count` of the run
    void expect_reproduced(std::vector<VirtualMachine::Speed> speeds, PlanKind kind,
                           const std::vector<int>& numbers, std::size_t count) {
        VirtualMachine machine(std::move(speeds), 20e-6);
        FramePlanner planner(*solver_, model_.strips.count(), machine.devices(), kind);
        for (const FramePlan& plan : planner.calibration()) {
            planner.learn(plan, machine.run(plan, 2), 2);
        }
        RunDescription run;
        run.kinds = solver_->kinds();
        run.devices.resize(count);
        PlanLog log(count);
        for (int i = 0; i < 12; ++i) {
            machine.speeds[0].per_item *= 1.07;  // so that plans change
            const FramePlan& plan = planner.next();
            FrameRecord frame;
            log.record(plan, planner.timing(), numbers, frame);
            expect_same(run, frame, plan.plan, numbers);
            EXPECT_EQ(frame.graph->strips.size(), count);
            graphs_.insert(frame.graph);
            planner.learn(plan, machine.run(plan, kSubsteps), kSubsteps);
        }
    }

    static void expect_same(const RunDescription& run, const FrameRecord& frame,
                            const scheduler::Plan& plan, const std::vector<int>& numbers) {
        const MachineCosts costs = recorded_costs(run, frame);
        ASSERT_EQ(costs.numbers.size(), numbers.size());
        const auto graph = rebuild_graph(run, frame, costs, true);
        const auto planner = scheduler::make_planner(frame.planner);
        ASSERT_TRUE(planner) << frame.planner;
        scheduler::Plan again;
        planner->plan(graph, again);
        EXPECT_EQ(again.makespan, plan.makespan);
        EXPECT_EQ(again.order, plan.order);
        ASSERT_EQ(again.placements.size(), plan.placements.size());
        for (std::size_t t = 0; t < plan.placements.size(); ++t) {
            const auto& own = plan.placements[t];
            EXPECT_EQ(again.placements[t].processor, own.processor);
            EXPECT_EQ(static_cast<int>(costs.numbers[own.processor]), numbers[own.processor]);
            EXPECT_EQ(again.placements[t].start, own.start);
        }
    }

    Warnings warnings_;
    Model model_;
    std::unique_ptr<Solver> solver_;
    std::set<std::shared_ptr<const GraphRecord>> graphs_;
};

TEST_F(PlanLogTest, ReproducesPlansOfTwoDevices) {
    expect_reproduced({{2e-6, 2e-9}, {8e-6, 3e-9}}, PlanKind::kExact, {0, 1}, 2);
    EXPECT_GT(graphs_.size(), 1U);
    EXPECT_LT(graphs_.size(), 12U);  // frames of one division share one
}

TEST_F(PlanLogTest, ReproducesPlansOfThreeDevices) {
    expect_reproduced({{2e-6, 2e-9}, {8e-6, 3e-9}, {1e-6, 5e-9}}, PlanKind::kAuto, {0, 1, 2}, 3);
}

TEST_F(PlanLogTest, ReproducesPlansOfOneDevice) {
    expect_reproduced({{2e-6, 2e-9}}, PlanKind::kSingle, {0}, 1);
    EXPECT_EQ(graphs_.size(), 1U);
}

/// Its record says where each task is, and how the strips were cut for it.
TEST_F(PlanLogTest, HoldsPlacements) {
    VirtualMachine machine({{2e-6, 2e-9}, {2e-6, 3e-9}}, 20e-6);
    FramePlanner planner(*solver_, model_.strips.count(), machine.devices(), PlanKind::kPlaced);
    for (const FramePlan& plan : planner.calibration()) {
        planner.learn(plan, machine.run(plan, 2), 2);
    }
    const FramePlan plan = planner.next();
    ASSERT_TRUE(plan.is_placed());
    FrameRecord frame;
    PlanLog(3).record(plan, planner.timing(), {0, 2}, frame);
    EXPECT_EQ(std::accumulate(frame.graph->strips.begin(), frame.graph->strips.end(), 0U),
              static_cast<std::uint32_t>(model_.strips.count()));
    ASSERT_EQ(frame.plan.size(), plan.step->tasks().size());
    for (const PlanRecord& task : frame.plan) {
        const auto device = plan.plan.placements[task.task].processor;
        EXPECT_EQ(task.device, device == 0 ? 0U : 2U);
        EXPECT_EQ(task.home, task.device);
        EXPECT_EQ(plan.plan.tasks_on(device)[task.order], task.task);
    }
}

TEST_F(PlanLogTest, KeepsTheNumbersOfDevicesWhenOneIsLost) {
    expect_reproduced({{2e-6, 2e-9}, {8e-6, 3e-9}}, PlanKind::kExact, {0, 2}, 3);
    for (const auto& graph : graphs_) EXPECT_EQ(graph->strips[1], 0U);
}

}  // namespace
}  // namespace weft::test
