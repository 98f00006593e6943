// A frame that is given up in its middle, as its plan was a mistake, leaves no trace.

#include <gtest/gtest.h>

#include "runtime/device_list.h"
#include "simulation/run/frame_runner.h"
#include "simulation/run/live_model.h"
#include "simulation/scene/read_scene.h"
#include "tests/simulation/run/test_scenes.h"

namespace weft::test {
namespace {

constexpr int kFrames = 4;

/// A run frame by frame, by whatever plan is next.
class FrameByFrame {
public:
    FrameByFrame(const std::string& scene, const std::string& devices, Method solver)
        : live_(
              with_solver(scene, solver), [](Model& model) { return make_solver(model); },
              warnings_),
          runner_(live_) {
        live_.place(0.0);
        live_.open(open_devices(devices),
                   {.plan = PlanKind::kExact, .division = {}, .cost_file = {}});
    }

    /// impatient  the first plan shows that it is a mistake, whatever it takes
    void advance(bool impatient) {
        live_.begin_frame();
        runner_.begin_frame();
        while (!run(impatient)) impatient = false;
        live_.end_frame();
        ++frame_;
    }

    /// Of the host's state.
    std::string hash() {
        SimulationState state;
        state.take(live_.model(), live_.solver());
        return state.hash(live_.model());
    }
    int given_up() const { return given_up_; }

private:
    static Scene with_solver(const std::string& text, Method solver) {
        Scene scene = parse_scene(text, "given_up.toml");
        scene.solver.method = solver;
        return scene;
    }

    bool run(bool impatient) {
        live_.planned().make_room_ahead();
        live_.place(frame_ * live_.model().scene.dt);
        FramePlan plan = live_.planned().next();
        if (impatient) plan.patience = 0.0;
        const auto times = runner_.run(plan, frame_, nullptr);
        if (!times) {
            ++given_up_;
            EXPECT_EQ(hash(), live_.start().hash(live_.model()));
            return false;
        }
        const int substeps = live_.model().scene.substeps;
        EXPECT_EQ(times->tasks.size(), live_.planned().devices().size());
        std::size_t tasks = 0;
        for (const auto& device : times->tasks) tasks += device.size();
        EXPECT_EQ(tasks, plan.step->tasks().size() * static_cast<std::size_t>(substeps));
        live_.planned().learn(plan, *times, substeps, frame_);
        return true;
    }

    Warnings warnings_;
    LiveModel live_;
    FrameRunner runner_;
    int frame_ = 0;
    int given_up_ = 0;
};

class GivenUp : public testing::TestWithParam<std::tuple<const char*, Method, const char*>> {};

TEST_P(GivenUp, AFrameLeavesNoTrace) {
    const auto& [devices, solver, contact] = GetParam();
    const std::string scene = kEverything + contact;
    FrameByFrame patient(scene, devices, solver), impatient(scene, devices, solver);
    for (int frame = 0; frame < kFrames; ++frame) {
        patient.advance(false);
        impatient.advance(frame % 2 == 1);
        ASSERT_EQ(impatient.hash(), patient.hash()) << "frame " << frame;
    }
    EXPECT_EQ(patient.given_up(), 0);
    EXPECT_EQ(impatient.given_up(), kFrames / 2);
}

INSTANTIATE_TEST_SUITE_P(Devices, GivenUp,
                         testing::Combine(testing::Values("cpu/1", "cpu/1+opencl:0/1"),
                                          testing::Values(Method::kXpbd, Method::kNewton),
                                          testing::Values("", "[contact]\n")));

}  // namespace
}  // namespace weft::test
