// What contacts have stored, in closed form, and in a run's account of its energy.

#include "simulation/contact/energy.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "runtime/error.h"
#include "simulation/contact/response.h"
#include "simulation/contact/stiffness.h"
#include "simulation/scene/method.h"
#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"
#include "simulation/state/diagnostics.h"
#include "tests/simulation/run/manual_run.h"

namespace weft::test {
namespace {

constexpr double kRange = 0.02;

/// A small sheet over the middle of one triangle of a large one that is held.
const std::string kOverATriangle = R"(
[scene]
frames = 20
dt = 0.002
substeps = 2
gravity = [0, 0, 0]
[solver]
iterations = 6
[contact]
thickness = 0.02
[[cloth]]
name = "low"
grid = { size = [2.0, 2.0], resolution = [2, 2] }
density = 0.2
stretch = { stiffness = 300.0 }
pins = { box = [[-9, -9, -9], [9, 9, 9]] }
[[cloth]]
name = "high"
grid = { size = [0.1, 0.1], resolution = [2, 2] }
translate = [0.4, 0.012, 0.3]
density = 0.2
stretch = { stiffness = 300.0 }
)";

/// E of kernels/contact/energy.h, in double precision [J].
double energy_of(double gap, double k) {
    const double tau = 0.5 * kRange;
    if (gap >= kRange) return 0.0;
    if (gap >= tau) return 0.5 * k * (kRange - gap) * (kRange - gap);
    return 0.5 * k * tau * tau * (1.0 + tau / gap - gap / tau);
}

/// Of the sheet's four vertices, each in contact with the face below it. stiffness: of the model as
/// it began
double stored_over(const Model& model, const std::vector<float>& stiffness) {
    double sum = 0.0;
    for (std::size_t v = 0; v < stiffness.size(); ++v) {
        const float4& x = (*model.positions)[v];
        if (x.w > 0.0f) sum += energy_of(double{x.y}, 4.0 * double{stiffness[v]});
    }
    return sum;
}

class ContactEnergyOf : public testing::TestWithParam<Method> {
protected:
    Scene scene() const {
        Scene scene = parse_scene(kOverATriangle, "test.toml");
        scene.solver.method = GetParam();
        return scene;
    }
    Warnings warnings_;
};

TEST_P(ContactEnergyOf, VerticesOverATriangle) {
    ManualRun run(scene());
    const auto stiffness = contact_stiffness(*run.model).between_sheets;
    const double start = stored_over(*run.model, stiffness);
    run.run_substeps(1);
    const double end = stored_over(*run.model, stiffness);
    const StoredInContacts stored = run.solver->contact()->energy().stored();
    EXPECT_NEAR(stored.start, start, 1e-5 * start);
    EXPECT_NEAR(stored.end, end, 1e-5 * start);
    EXPECT_GT(end, 0.01 * start) << "still there";
    EXPECT_LT(end, 0.9 * start) << "something has happened";
}

/// The first substep begins where the frame does, whatever comes behind it.
TEST_P(ContactEnergyOf, TheStartIsTheFrames) {
    ManualRun run(scene());
    const double start = stored_over(*run.model, contact_stiffness(*run.model).between_sheets);
    run.run(1);
    EXPECT_NEAR(run.solver->contact()->energy().stored().start, start, 1e-5 * start);
}

SimulationOptions on_one_core() {
    SimulationOptions options;
    options.devices = "cpu/1";
    options.calibrate = false;
    return options;
}

/// Nothing but what contacts have stored sets it moving: that is no energy from nowhere.
TEST_P(ContactEnergyOf, WhatWasStoredAtTheStartWasThereToBeHad) {
    Simulation run(scene(), on_one_core(), warnings_);
    const double stored = stored_over(run.model(), contact_stiffness(run.model()).between_sheets);
    double start = 0.0;
    for (int frame = 0; frame < 20; ++frame) {
        const FrameRecord record = run.advance();
        if (frame == 0) start = record.dissipated + run.energies().total();
        ASSERT_EQ(record.energies.size(), energy_names(run.model()).size());
        EXPECT_EQ(record.energies.back(), run.energies().contact);
        EXPECT_GT(record.dissipated, -1e-6 * start) << frame;
        EXPECT_NEAR(record.dissipated + run.energies().total(), start, 1e-12);
    }
    EXPECT_EQ(energy_names(run.model()).back(), "contact");
    EXPECT_EQ(run.energies().contact, 0.0) << "out of reach by now";
    EXPECT_GT(run.energies().kinetic, 0.01 * start);
    EXPECT_TRUE(run.troubles().empty());
    EXPECT_NEAR(start, stored, 1e-5 * stored);
}

TEST_P(ContactEnergyOf, AnInterruptedRunGoesOnWithTheSameAccount) {
    Scene scene = this->scene();
    scene.substeps = 1;
    Simulation whole(scene, on_one_core(), warnings_);
    whole.advance();
    const Checkpoint checkpoint = whole.checkpoint();
    Simulation rest(scene, on_one_core(), warnings_);
    rest.resume(checkpoint);
    ASSERT_GT(whole.energies().contact, 0.0);
    EXPECT_EQ(rest.energies().contact, whole.energies().contact);
    for (int frame = 1; frame < 4; ++frame) {
        EXPECT_EQ(rest.advance().dissipated, whole.advance().dissipated) << frame;
    }
    EXPECT_EQ(rest.hash(), whole.hash());
}

/// Contacts are as stiff as the step is short: what that adds comes from nowhere, and is known.
TEST_P(ContactEnergyOf, ShorterStepsStoreMore) {
    Scene scene = this->scene();
    scene.substeps = 1;
    Simulation run(scene, on_one_core(), warnings_);
    const double before = run.advance().dissipated;
    const double had = before + run.energies().total();
    ASSERT_GT(run.energies().contact, 0.0);
    run.set_steps(4, 6);
    const double after = run.advance().dissipated;
    EXPECT_GT(after + run.energies().total(), had);
    EXPECT_GT(after, before - 1e-6);
    EXPECT_TRUE(run.troubles().empty());
}

/// Five sheets that fall on a plane together are too much for a few iterations of xpbd where
/// contacts are made a hundred times as hard: these store many times the energy that is there.
TEST(Contact, EnergyFromNowhereInContactsIsTold) {
    const auto sheet = [](int number) {
        return fmt::format(R"(
[[cloth]]
grid = {{ size = [0.3, 0.3], resolution = [7, 7] }}
translate = [{}, {}, 0.0]
rotate = [0.0, 1.0, 0.0, {}]
density = 0.2
stretch = {{ stiffness = 1.0e3 }}
bend = {{ stiffness = 1.0e-4 }}
)",
                           0.005 * number, 0.01 * (number + 1), 7 * number);
    };
    const std::string head = R"(
[scene]
frames = 4
dt = 0.016666667
substeps = 2
[solver]
method = "xpbd"
iterations = 2
[contact]
thickness = 0.01
friction = 0.3
stiffness = 100
[[obstacle]]
shape = "plane"
point = [0.0, 0.0, 0.0]
friction = 0.3
)";
    Warnings warnings;
    const auto troubles = [&](int sheets) {
        std::string text = head;
        for (int number = 0; number < sheets; ++number) text += sheet(number);
        Simulation run(parse_scene(text, "test.toml"), on_one_core(), warnings);
        for (int frame = 0; frame < 4; ++frame) run.advance();
        return run.troubles();
    };
    EXPECT_TRUE(troubles(1).empty());
    const auto told = troubles(5);
    ASSERT_FALSE(told.empty());
    EXPECT_NE(told[0].what.find("in contacts"), std::string::npos) << told[0].what;
}

INSTANTIATE_TEST_SUITE_P(Methods, ContactEnergyOf,
                         testing::Values(Method::kVbd, Method::kSosd, Method::kJpgd, Method::kXpbd,
                                         Method::kNewton),
                         [](const auto& given) { return std::string(name_of(given.param)); });

}  // namespace
}  // namespace weft::test
