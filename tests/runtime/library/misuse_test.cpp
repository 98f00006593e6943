// What a program may get wrong is told, by one clear message each, in every kind of build.

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <optional>

#include "runtime/executor.h"
#include "scheduler/planner.h"
#include "tests/runtime/library/own_work.h"
#include "weft/error.h"
#include "weft/version.h"

namespace weft::test {
namespace {

/// What is thrown, as text; empty: nothing.
std::string message_of(const std::function<void()>& mistake) {
    try {
        mistake();
    } catch (const std::exception& error) {
        return error.what();
    }
    return {};
}

void expect_message(const std::function<void()>& mistake, const std::vector<std::string>& parts) {
    const std::string message = message_of(mistake);
    ASSERT_FALSE(message.empty()) << "nothing was thrown";
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const std::string& part : parts) {
        EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks: " << part;
    }
}

// ---- the scheduler ----

scheduler::TaskGraph two_tasks() {
    scheduler::TaskGraph graph(2);
    const double cost[] = {1.0, 2.0};
    graph.add_task(cost, {.name = "a"});
    graph.add_task(cost, {.name = "b"});
    graph.add_edge(0, 1, 1.0);
    return graph;
}

TEST(Misuse, AnUnsealedGraph) {
    for (const std::string_view name : scheduler::planner_names()) {
        const auto planner = scheduler::make_planner(name);
        scheduler::Plan plan;
        expect_message([&] { planner->plan(two_tasks(), plan); }, {"not sealed", "seal()"});
    }
}

TEST(Misuse, AnUnknownPlanner) {
    expect_message([] { scheduler::make_planner("hefty"); }, {"'hefty'", "heft", "portfolio"});
}

TEST(Misuse, AnEdgeToNowhere) {
    scheduler::TaskGraph graph = two_tasks();
    expect_message([&] { graph.add_edge(0, 7, 1.0); }, {"#7", "2 tasks"});
}

TEST(Misuse, ACycle) {
    scheduler::TaskGraph graph = two_tasks();
    graph.add_edge(1, 0, 1.0);
    expect_message([&] { graph.seal(); }, {"cycle", "a -> b -> a"});
}

TEST(Misuse, CostsForOtherProcessors) {
    scheduler::TaskGraph graph(3);
    const double cost[] = {1.0, 2.0};
    expect_message([&] { graph.add_task(cost); }, {"2 costs for 3 processors"});
}

// ---- steps, plans and the executor ----

/// One task over all strips, and an executor for it.
struct OneTask {
    OwnWork own;
    TaskBody body{"all", 0, {own.spread(own.now, own.next)}};
    Step step;
    std::vector<std::unique_ptr<Device>> devices = open_devices("cpu/1");
    std::optional<Executor> executor;

    OneTask() {
        add_task();
        const TaskBody* const bodies[] = {&body};
        executor.emplace(std::vector{devices[0].get()}, bodies);
    }
    void add_task() {
        step.add(body, 0, {0, OwnWork::kStrips})
            .reads(own.now, own.strips)
            .reads_by_instance(own.losses, OwnWork::kZones)
            .updates(own.next, own.strips);
    }
    static scheduler::Plan plan_for(std::size_t tasks, scheduler::ProcessorId device = 0,
                                    scheduler::ProcessorId devices = 1) {
        scheduler::Plan plan;
        plan.placements.resize(tasks, {0.0, 1.0, device});
        plan.order_by_start(devices);
        return plan;
    }
};

TEST(Misuse, AnUnsealedStep) {
    OneTask one;
    expect_message([&] { one.executor->run(one.step, OneTask::plan_for(1), 1); },
                   {"not sealed", "seal()"});
}

TEST(Misuse, ATaskBehindTheSeal) {
    OneTask one;
    one.step.seal();
    expect_message([&] { one.add_task(); }, {"sealed"});
    expect_message([&] { one.step.seal(); }, {"sealed"});
}

TEST(Misuse, AnEmptyPlan) {
    OneTask one;
    one.step.seal();
    expect_message([&] { one.executor->run(one.step, {}, 1); }, {"0 tasks", "the step has 1"});
}

TEST(Misuse, APlanOfAnotherGraph) {
    OneTask one;
    one.step.seal();
    expect_message([&] { one.executor->run(one.step, OneTask::plan_for(3), 1); },
                   {"3 tasks", "the step has 1"});
}

TEST(Misuse, APlanForOtherDevices) {
    OneTask one;
    one.step.seal();
    expect_message([&] { one.executor->run(one.step, OneTask::plan_for(1, 1, 2), 1); },
                   {"2 devices", "there are 1"});
}

TEST(Misuse, APlanWhoseOrderCannotBeFollowed) {
    OneTask one;
    one.step.add(one.body, 0, {0, OwnWork::kStrips}).updates(one.own.next, one.own.strips);
    one.step.seal();
    scheduler::Plan plan = OneTask::plan_for(2);
    std::swap(plan.order[0], plan.order[1]);
    expect_message([&] { one.executor->run(one.step, plan, 1); }, {"cannot be followed"});
}

TEST(Misuse, NoInstances) {
    OneTask one;
    one.step.seal();
    expect_message([&] { one.executor->run(one.step, OneTask::plan_for(1), 0); },
                   {"at least one instance"});
}

TEST(Misuse, MoreInstancesThanABufferHas) {
    OneTask one;
    one.step.seal();
    const int most = OwnWork::kInstances;
    EXPECT_EQ(message_of([&] { one.executor->run(one.step, OneTask::plan_for(1), most); }), "");
    expect_message([&] { one.executor->run(one.step, OneTask::plan_for(1), most + 1); },
                   {"'losses'", "8 instances", "9"});
}

TEST(Misuse, ABufferThatDiesBeforeWhatRunsOnIt) {
    OneTask one;
    auto next = std::make_unique<Buffer<own::Cell>>("short-lived", OwnWork::kCells);
    const TaskBody body{"all", 0, {one.own.spread(one.own.now, *next)}};
    const TaskBody* const bodies[] = {&body};
    Executor executor({one.devices[0].get()}, bodies);
    Step step;
    step.add(body, 0, {0, OwnWork::kStrips}).updates(*next, one.own.strips);
    step.seal();
    next.reset();
    expect_message([&] { executor.run(step, OneTask::plan_for(1), 1); }, {"'short-lived'"});
}

TEST(Misuse, ABodyThatTheExecutorDoesNotKnow) {
    OneTask one;
    const TaskBody other{"other", 0, one.body.launches};
    Step step;
    step.add(other, 0, {0, OwnWork::kStrips}).updates(one.own.next, one.own.strips);
    step.seal();
    expect_message([&] { one.executor->run(step, OneTask::plan_for(1), 1); }, {"'other'"});
}

TEST(Misuse, AnAccessOutsideItsBuffer) {
    OneTask one;
    const auto access = [&] {
        one.step.add(one.body, 0, {0, 1}).reads(one.own.losses, 0, 1 << 20);
    };
    expect_message(access, {"'all'", "'losses'", "no such part"});
}

TEST(Misuse, StripsThatALaunchDoesNotHave) {
    OneTask one;
    expect_message(
        [&] {
            one.step.add(one.body, 0, {0, OwnWork::kStrips + 1});
        },
        {"'all'", "[0, 13)", "'spread'", "[0, 12)"});
}

TEST(Misuse, ABufferInUnitsOfTwoKinds) {
    OneTask one;
    one.step.add(one.body, 0, {0, 1}).reads(one.own.now, 0, 5);
    expect_message([&] { one.step.seal(); }, {"'now'", "units of another kind"});
}

// ---- kernels ----

struct Forgotten {
    static constexpr const char* kName = "forgotten";
    static constexpr const char* kSpace = "own::";
    static void run(int, float*) {}
};

TEST(Misuse, AKernelThatNobodyCompiled) {
    Buffer<float> buffer("b", 1);
    expect_message([&] { launch(Forgotten{}, Segments{}, buffer); },
                   {"'own::forgotten'", "weft_add_kernels"});
}

/// Registered as if only some of its forms had been compiled.
struct Partial {
    static constexpr const char* kName = "partial";
    static constexpr const char* kSpace = "own::";
    static void run(int, float*) {}
};

std::unique_ptr<Runner> run_partial(const std::string& devices) {
    static const bool added =
        kernels::add_kernel("own::partial", {.name = "partial",
                                             .space = "own::",
                                             .file = "partial.h",
                                             .parameters = {kernels::Parameter::kWriteFloat},
                                             .parameter_text = "float* p"}) &&
        kernels::add_range_function(kernels::Target::kScalar, "own::partial",
                                    [](int, int, const void* const*) {});
    EXPECT_TRUE(added);
    static Buffer<float> data("data", 8);
    static Buffer<int> begin("strips", 3);
    static const Segments strips = even_strips(begin, 8);
    static StripWork work(2);
    if (work.bodies().empty()) {
        work.add("partial", launch(Partial{}, strips, data)).updates(data, strips);
    }
    return std::make_unique<Runner>(work, RunnerOptions{.devices = devices});
}

TEST(Misuse, AKernelWithoutAPackedVariant) {
    expect_message([] { run_partial("cpu/1"); }, {"'own::partial'", "packed", "weft_add_kernels"});
}

TEST(Misuse, AKernelWithoutTextForOpenCl) {
    expect_message([] { run_partial("opencl:0/1"); },
                   {"'own::partial'", "OpenCL", "weft_add_kernels"});
}

TEST(Misuse, PacksOfASizeThatNoKernelHas) {
    for (const int lanes : {-1, 4, 32}) {
        DeviceOptions options;
        options.cpu_lanes = lanes;
        expect_message([&] { open_devices("cpu/1", options); },
                       {"cpu_lanes is " + std::to_string(lanes), "1, 8 or 16"});
    }
}

// ---- work and runners ----

TEST(Misuse, WorkWithoutStagesOrStrips) {
    StripWork none(4);
    expect_message([&] { Runner(none, {.devices = "cpu/1"}); }, {"no stages"});
    expect_message([] { StripWork(0); }, {"at least one strip"});
    expect_message([] { StepWork{Step{}}; }, {"no tasks"});
}

TEST(Misuse, AStepThatIsNotSealedAsWork) {
    OwnWork own;
    Step step;
    step.add(*own.work.bodies().front(), 0, {0, 1}).updates(own.next, own.strips);
    expect_message([&] { StepWork{step}; }, {"not sealed"});
}

/// What a runner says of a stage with these accesses.
std::string runner_on(const std::function<void(OwnWork&, StripWork::Stage)>& describe) {
    OwnWork own;
    StripWork work(OwnWork::kStrips);
    describe(own, work.add("there", own.spread(own.now, own.next)));
    return message_of([&] { Runner(work, {.devices = "cpu/1"}); });
}

TEST(Misuse, AStageThatDoesNotSayWhatItsKernelsUse) {
    using Stage = StripWork::Stage;
    const std::string all = runner_on([](OwnWork& own, Stage stage) {
        stage.reads(own.now, own.strips, 1).reads(own.losses).updates(own.next, own.strips);
    });
    EXPECT_EQ(all, "");
    const std::string written = runner_on([](OwnWork& own, Stage stage) {
        stage.reads(own.now, own.strips, 1).reads(own.losses).reads(own.next, own.strips);
    });
    EXPECT_NE(written.find("'spread' writes 'next'"), std::string::npos) << written;
    EXPECT_NE(written.find(".updates() is missing"), std::string::npos) << written;
    const std::string read = runner_on([](OwnWork& own, Stage stage) {
        stage.reads(own.now, own.strips, 1).updates(own.next, own.strips);
    });
    EXPECT_NE(read.find("'spread' reads 'losses'"), std::string::npos) << read;
    const std::string none = runner_on([](OwnWork&, Stage) {});
    EXPECT_NE(none.find("the task does not say so"), std::string::npos) << none;
}

TEST(Misuse, AStageThatReadsWhatItsNeighboursWrite) {
    const std::string told = runner_on([](OwnWork& own, StripWork::Stage stage) {
        stage.reads(own.now, own.strips, 1).reads(own.losses);
        stage.reads(own.next, own.strips, 1).updates(own.next, own.strips);
    });
    EXPECT_NE(told.find("reads other strips of 'next'"), std::string::npos) << told;
}

TEST(Misuse, AStageThatDoesNotSayThatItReadsAGate) {
    OwnWork own;
    StripWork work(OwnWork::kStrips);
    Buffer<int> gate("gate", OwnWork::kStrips);
    work.add("there", only_where(gate, own.spread(own.now, own.next)))
        .reads(own.now, own.strips, 1)
        .reads(own.losses)
        .updates(own.next, own.strips);
    expect_message([&] { Runner(work, {.devices = "cpu/1"}); },
                   {"'spread' reads 'gate'", ".reads() is missing"});
}

TEST(Misuse, AGateForFewerStripsThanTheLaunchHas) {
    OwnWork own;
    Buffer<int> gate("gate", OwnWork::kStrips - 1);
    expect_message([&] { only_where(gate, own.spread(own.now, own.next)); },
                   {"'gate'", "'spread'", std::to_string(OwnWork::kStrips) + " strips"});
}

TEST(Misuse, BuffersAndStripTablesThatAreGoneBeforeTheRunner) {
    OwnWork own;
    StripWork on_buffer(OwnWork::kStrips), on_strips(OwnWork::kStrips);
    {
        Buffer<own::Cell> gone("gone", OwnWork::kCells);
        on_buffer.add("there", own.spread(own.now, gone));
        Buffer<int> begin("begin", OwnWork::kStrips + 1);
        const Segments strips = even_strips(begin, OwnWork::kCells);
        on_strips.add("there", launch(own::spread, strips, own.now, own.next, own.losses,
                                      OwnWork::kCells, 0.2f, OwnWork::kZones, kInstance));
    }
    for (StripWork* work : {&on_buffer, &on_strips}) {
        expect_message([&] { Runner(*work, {.devices = "cpu/1"}); },
                       {"'there'", "'spread'", "is gone"});
    }
}

TEST(Misuse, StripTablesThatAreNone) {
    const auto message = [](const std::function<void(OwnWork&)>& spoil) {
        OwnWork own;
        spoil(own);
        return message_of([&] { Runner(own.work, {.devices = "cpu/1"}); });
    };
    EXPECT_NE(message([](OwnWork& own) { own.begin[3] = 5; }).find("value 3 is 5"),
              std::string::npos);
    EXPECT_NE(message([](OwnWork& own) { own.begin.resize(5); }).find("13 values, and it has 5"),
              std::string::npos);
    EXPECT_NE(message([](OwnWork& own) {
                  for (int& value : own.begin.span()) value = 0;
              }).find("no strip has an item"),
              std::string::npos);
}

TEST(Misuse, ABufferOfMoreThanCanBeNumbered) {
    expect_message([] { Buffer<float>("many", static_cast<std::size_t>(-1)); }, {"'many'"});
    Buffer<float> some("some", 4);
    expect_message([&] { some.resize(std::size_t{1} << 40); }, {"'some'", "1099511627776"});
    EXPECT_EQ(some.count(), 4U);
}

TEST(Misuse, ABufferThatIsResizedUnderARunner) {
    OwnWork own;
    Runner runner(own.work, {.devices = "cpu/1"});
    runner.advance(1);
    own.now.resize(50);
    expect_message([&] { runner.advance(1); }, {"'now'", "resized"});
}

TEST(Misuse, AStripTableThatIsChangedUnderARunner) {
    OwnWork own;
    Runner runner(own.work, {.devices = "cpu/1"});
    runner.advance(1);
    const int begin = own.begin[1];
    own.begin[1] = begin + 1;
    expect_message([&] { runner.advance(1); }, {"strips '" + own.begin.name() + "'", "changed"});
    own.begin[1] = begin;
    runner.advance(1);
}

TEST(Misuse, FramesBehindTheEnd) {
    OwnWork own;
    Runner runner(own.work, {.devices = "cpu/1", .name = "two options in braces"});
    runner.finish();
    expect_message([&] { runner.advance(1); }, {"finished"});
}

TEST(Misuse, AStageOverOtherStripsThanTheWorks) {
    OwnWork own;
    StripWork work(OwnWork::kStrips + 1);
    expect_message([&] { work.add("s", own.spread(own.now, own.next)); }, {"'s'", "12", "13"});
}

TEST(Misuse, AFrameOfNoInstancesOrTooMany) {
    OwnWork own;
    Runner runner(own.work, {.devices = "cpu/1"});
    expect_message([&] { runner.advance(0); }, {"at least one instance"});
    expect_message([&] { runner.advance(OwnWork::kInstances + 1); }, {"'losses'"});
    runner.advance(OwnWork::kInstances);
    EXPECT_EQ(runner.frame(), 1);
}

TEST(Misuse, DevicesThatAreNotThere) {
    OwnWork own;
    expect_message([&] { Runner(own.work, {.devices = "gpx"}); }, {"gpx"});
    expect_message([&] { Runner(own.work, std::vector<std::unique_ptr<Device>>{}); },
                   {"at least one device"});
}

TEST(Misuse, ATraceOfOtherWork) {
    OwnWork own;
    Runner runner(own.work, {.devices = "cpu/1"});
    FrameRecord frame;
    frame.substeps = 1;
    expect_message([&] { runner.replay(runner.describe(), frame); }, {"cannot be replayed"});
}

TEST(Misuse, AWorkWhoseStepDoesNotFitItsPartition) {
    class Lying final : public Work {
    public:
        explicit Lying(OwnWork& own) : own_(own) {}
        int strip_count() const override { return OwnWork::kStrips; }
        std::vector<const TaskBody*> bodies() const override { return own_.work.bodies(); }
        std::vector<std::string> kinds() const override { return own_.work.kinds(); }
        Step make_step(const Partition&) override {
            Step step;
            step.add(*bodies().front(), 0, {0, 1}, RegionId{5})
                .reads(own_.now, own_.strips)
                .reads_by_instance(own_.losses, OwnWork::kZones)
                .updates(own_.next, own_.strips);
            step.seal();
            return step;
        }

    private:
        OwnWork& own_;
    };
    OwnWork own;
    Lying lying(own);
    expect_message([&] { Runner(lying, {.devices = "cpu/1"}).advance(1); },
                   {"'there'", "region 5", "1 part"});
}

TEST(Version, IsTheLibrarys) {
    EXPECT_STREQ(library_version(), WEFT_VERSION_TEXT);
    EXPECT_EQ(message_of([] { require_matching_library(); }), "");
}

}  // namespace
}  // namespace weft::test
