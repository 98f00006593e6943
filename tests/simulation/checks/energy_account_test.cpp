// What speaks against a state, of the energy alone.

#include "simulation/checks/energy_account.h"

#include <gtest/gtest.h>

#include <limits>

#include "simulation/checks/body_accounts.h"
#include "simulation/scene/read_scene.h"
#include "simulation/state/diagnostics.h"
#include "tests/simulation/run/manual_run.h"
#include "tests/simulation/run/one_plan.h"

namespace weft::test {
namespace {

/// A sheet that nothing holds, 1.41 m from corner to corner.
Scene loose_sheet() {
    return parse_scene(R"(
[scene]
frames = 1
dt = 0.016666667
[[cloth]]
grid = { size = [1.0, 1.0], resolution = [5, 5] }
density = 0.2
stretch = { stiffness = 1.0e4 }
)",
                       "test.toml");
}

Energies energies_of(const Model& model) {
    return measure_energies(model, model.positions->span(), model.velocities->span(), 0.0);
}

/// Whether there is something against the sheet that is at rest, by so much higher than it began.
bool is_told_of(double lift) {
    ManualRun sheet(loose_sheet());
    Model& model = *sheet.model;
    const EnergyAccount account(model, energies_of(model));
    for (float4& x : model.positions->span()) x.y += static_cast<float>(lift);
    const auto entry = account.with_frame(0.0, {}, energies_of(model));
    const auto alarm = account.look(entry, {}, model);
    if (!alarm) return false;
    EXPECT_FALSE(alarm->is_explosion);
    EXPECT_NE(alarm->what.find("to be as high as it is takes"), std::string::npos) << alarm->what;
    return true;
}

TEST(EnergyAccount, TellsOfWhatIsLiftedByNothing) {
    EXPECT_FALSE(is_told_of(-0.1));
    EXPECT_FALSE(is_told_of(0.003));
    EXPECT_TRUE(is_told_of(0.004));
    EXPECT_TRUE(is_told_of(1.0));
}

/// Of a sheet and a block without contact: whether there is something against them, at rest but the
/// block so many times as long as it was.
bool is_told_of_longer(float block) {
    ManualRun run(parse_scene(R"(
[scene]
frames = 1
dt = 0.016666667
[[cloth]]
grid = { size = [0.2, 0.2], resolution = [5, 5] }
density = 0.2
stretch = { stiffness = 1.0e4 }
[[solid]]
grid = { size = [0.2, 0.2, 0.2], resolution = [3, 3, 3] }
density = 100.0
young = 1.0e6
poisson = 0.3
)",
                              "test.toml"));
    Model& model = *run.model;
    const EnergyAccount account(model, energies_of(model));
    for (int v = 0; v < model.vertex_count(); ++v) {
        const bool is_of_sheet = index(model.scene_vertex(v)) < 25;
        if (!is_of_sheet) (*model.positions)[static_cast<std::size_t>(v)].x *= block;
    }
    return account.look(account.with_frame(0.0, {}, energies_of(model)), {}, model).has_value();
}

/// Nor is a sheet that stays as it is a reason to believe a block that does not.
TEST(EnergyAccount, TellsOfSolidsBesideCloth) {
    EXPECT_FALSE(is_told_of_longer(1.0f));
    EXPECT_TRUE(is_told_of_longer(1.2f));
}

/// Strain that hardly shows in edges is excused where it is several times what there was to be had
/// (here seven times), but not without limit.
TEST(EnergyAccount, TellsOfStrainThatDoesNotShow) {
    ManualRun sheet(loose_sheet());
    Model& model = *sheet.model;
    const EnergyAccount account(model, energies_of(model));
    const auto is_told_of = [&](float longer) {
        for (float4& x : model.positions->span()) x.x *= longer;
        const Energies energies = energies_of(model);
        const auto alarm = account.look(account.with_frame(0.0, {}, energies), {}, model);
        for (float4& x : model.positions->span()) x.x /= longer;
        return alarm.has_value();
    };
    EXPECT_FALSE(is_told_of(1.005f));
    EXPECT_TRUE(is_told_of(1.02f));
}

/// What is dissipated does not come back, though it is less than there was to be had.
TEST(EnergyAccount, CountsWhatIsGained) {
    ManualRun sheet(loose_sheet());
    Model& model = *sheet.model;
    EnergyAccount account(model, energies_of(model));
    const auto gained_at = [&](float height) {
        for (float4& x : model.positions->span()) x.y = height;
        account.accept(account.with_frame(0.0, {}, energies_of(model)));
        return account.last().gained();
    };
    const double weight = 9.81 * 0.2;
    EXPECT_EQ(gained_at(-1.0f), 0.0);
    EXPECT_NEAR(gained_at(-0.75f), 0.25 * weight, 1e-6);
    EXPECT_NEAR(gained_at(-0.5f), 0.5 * weight, 1e-6);
    EXPECT_EQ(gained_at(-2.0f), 0.0);
    EXPECT_NEAR(account.last().dissipated(), 2.0 * weight, 1e-6);
}

/// Strain of that size would be excused, and so would motion: the sheet fell by a metre. But what
/// it lost in that is gone.
TEST(EnergyAccount, TellsOfMotionThatComesBack) {
    ManualRun sheet(loose_sheet());
    Model& model = *sheet.model;
    EnergyAccount account(model, energies_of(model));
    const auto alarm_at = [&](float height, float longer) {
        for (float4& x : model.positions->span()) {
            x.x *= longer;
            x.y = height;
        }
        const Energies energies = energies_of(model);
        for (float4& x : model.positions->span()) x.x /= longer;
        account.accept(account.with_frame(0.0, {}, energies));
        return account.look(account.last(), {}, model);
    };
    EXPECT_FALSE(alarm_at(-1.0f, 1.0f));
    EXPECT_FALSE(alarm_at(-1.0f, 1.01f)) << "it has strain that does not show";
    EXPECT_GT(account.last().gained(), 0.8);
    EXPECT_FALSE(alarm_at(-0.9f, 1.0f)) << "up to a tenth";
    const auto alarm = alarm_at(-0.75f, 1.01f);
    ASSERT_TRUE(alarm);
    EXPECT_FALSE(alarm->is_explosion);
    EXPECT_NE(alarm->what.find("0.49 J of motion or height are again there"), std::string::npos)
        << alarm->what;
    account.forgive(false);
    EXPECT_FALSE(alarm_at(-0.75f, 1.0f));
}

/// What was warned of is there for other warnings, and not for what explodes step by step.
TEST(EnergyAccount, WhatCreepsUpExplodesInTheEnd) {
    for (const bool was_explosion : {false, true}) {
        ManualRun sheet(loose_sheet());
        Model& model = *sheet.model;
        EnergyAccount account(model, energies_of(model));
        const auto alarm_at = [&](float speed) {
            for (float4& u : model.velocities->span()) u.x = speed;
            account.accept(account.with_frame(0.0, {}, energies_of(model)));
            return account.look(account.last(), {}, model);
        };
        const auto first = alarm_at(1.0f);
        ASSERT_TRUE(first);
        EXPECT_FALSE(first->is_explosion) << "0.1 J, of which 0.03 are excused";
        account.forgive(was_explosion);
        EXPECT_FALSE(alarm_at(1.1f));
        const auto second = alarm_at(1.75f);
        ASSERT_TRUE(second);
        EXPECT_EQ(second->is_explosion, !was_explosion);
    }
}

/// Sheets that start pressed together may have far more in contacts than comes out of them: that
/// must not excuse what comes from nowhere later.
TEST(EnergyAccount, WhatContactsLoseAtOnceIsNoExcuse) {
    ManualRun sheet(loose_sheet());
    Model& model = *sheet.model;
    EnergyAccount account(model, energies_of(model));
    const auto is_told_at = [&](float height, double found) {
        for (float4& x : model.positions->span()) x.y = height;
        const auto entry = account.with_frame(0.0, {}, energies_of(model), found);
        account.accept(entry);
        return account.look(entry, {}, model).has_value();
    };
    EXPECT_FALSE(is_told_at(0.0f, 1000.0));
    EXPECT_NEAR(account.last().dissipated(), 1000.0, 1e-6);
    EXPECT_FALSE(is_told_at(-0.1f, 0.0));
    EXPECT_TRUE(is_told_at(1.0f, 0.0));
}

/// What one body sets free as it falls is not there for another one.
TEST(BodyAccounts, TellsOfABodyBesideOneThatFalls) {
    const Scene scene = parse_scene(R"(
[scene]
frames = 1
dt = 0.016666667
[[cloth]]
name = "sheet"
grid = { size = [1.0, 1.0], resolution = [5, 5] }
density = 0.2
stretch = { stiffness = 1.0e4 }
pins = { edges = ["x-"] }
[[solid]]
name = "block"
grid = { size = [0.2, 0.2, 0.2], resolution = [3, 3, 3] }
translate = [3.0, 0.0, 0.0]
density = 1000.0
young = 1.0e6
poisson = 0.3
)",
                                    "test.toml");
    ManualRun run(scene);
    Model& model = *run.model;
    const EnergyAccount account(model, energies_of(model));
    BodyAccounts bodies(model);
    const auto tells = [&] { return bodies.look(model, bodies.measure(model, 8.0 * scene.dt)); };
    EXPECT_FALSE(tells());
    EXPECT_TRUE(bodies.measure(model, scene.dt).empty()) << "a frame in which nothing is measured";

    constexpr double kOfSheet = 0.0126;  // [kg] a vertex at the most; the block's corners have 0.04
    for (std::size_t v = 0; v < model.positions->count(); ++v) {
        if (model.masses[v] > kOfSheet) (*model.positions)[v].y -= 2.0f;
    }
    EXPECT_FALSE(tells()) << "what falls may";
    for (std::size_t v = 0; v < model.positions->count(); ++v) {
        if (model.masses[v] <= kOfSheet) (*model.velocities)[v].x = 2.0f;
    }
    const auto alarm = tells();
    ASSERT_TRUE(alarm);
    EXPECT_NE(alarm->what.find("energy from nowhere: cloth 'sheet' has"), std::string::npos)
        << alarm->what;
    EXPECT_FALSE(account.look(account.with_frame(0.0, {}, energies_of(model)), {}, model));

    bodies.forgive(bodies.measure(model, 8.0 * scene.dt));
    EXPECT_FALSE(tells());
}

/// What was not known of is forgotten once all is known again: what there is then was there.
TEST(EnergyAccount, BeginsAnewWhereWorkIsKnownAgain) {
    ManualRun sheet(loose_sheet());
    Model& model = *sheet.model;
    EnergyAccount account(model, energies_of(model));
    const auto stand_at = [&](float height) {
        for (float4& x : model.positions->span()) x.y = height;
        return energies_of(model);
    };
    const double unknown = std::numeric_limits<double>::infinity();
    const auto look = [&](const EnergyAccount::Entry& entry) {
        const auto alarm = account.look(entry, {}, model);
        account.accept(entry);
        return alarm.has_value();
    };
    EXPECT_FALSE(look(account.with_frame(0.0, {0.0, unknown}, stand_at(1.0f))));
    EXPECT_FALSE(look(account.with_frame(0.1, {0.0, unknown}, stand_at(2.0f))));
    EXPECT_FALSE(look(account.with_frame(0.2, {}, stand_at(2.0f))));
    EXPECT_TRUE(look(account.with_frame(0.3, {}, stand_at(2.1f))));
}

/// While pins move in ways of their own, nobody knows their work. Once they rest, it is known
/// again.
TEST(EnergyAccount, TellsOnceThePinsRest) {
    const Scene scene = parse_scene(R"(
[scene]
frames = 12
dt = 0.016666667
substeps = 1
[solver]
iterations = 2
[[cloth]]
grid = { size = [1.0, 1.0], resolution = [40, 40] }
density = 0.2
stretch = { stiffness = 1.0e5 }
damping = 0.1
[[cloth.pins]]
corners = ["x-z-"]
[[cloth.pins]]
corners = ["x+z-"]
motion.keyframes = [{ time = 0.0 }, { time = 0.03, translate = [-0.01, 0.0, 0.0] }]
)",
                                    "test.toml");
    Simulation simulation = simulation_of(scene, OnTrouble::kReport);
    while (simulation.frame() < scene.frames) simulation.advance();
    ASSERT_FALSE(simulation.troubles().empty());
    EXPECT_NE(simulation.troubles()[0].what.find("energy from nowhere"), std::string::npos);
}

}  // namespace
}  // namespace weft::test
