#include <gtest/gtest.h>

#include "runtime/error.h"
#include "scene_text.h"
#include "simulation/scene/read_scene.h"

namespace weft {
namespace {

Scene with(const std::vector<std::string>& assignments) {
    std::vector<Override> overrides;
    for (const std::string& text : assignments) overrides.push_back({text, "--set " + text});
    return parse_scene(test::kFullScene, "s.toml", overrides);
}

std::string message_of(const std::string& assignment) {
    try {
        with({assignment});
    } catch (const UserError& error) {
        return error.what();
    }
    return "no error";
}

TEST(Overrides, SetPlainValues) {
    const Scene scene = with({"scene.frames=7", "scene.dt=0.5", "guard.max_strain=3"});
    EXPECT_EQ(scene.frames, 7);
    EXPECT_EQ(scene.dt, 0.5);
    EXPECT_EQ(scene.guard.max_strain, 3.0);
    EXPECT_EQ(scene.overrides,
              (std::vector<std::string>{"scene.frames=7", "scene.dt=0.5", "guard.max_strain=3"}));
}

TEST(Overrides, LaterOnesWin) { EXPECT_EQ(with({"scene.frames=7", "scene.frames=8"}).frames, 8); }

TEST(Overrides, BareWordsAreStrings) {
    EXPECT_EQ(with({"scene.name=other"}).name, "other");
    EXPECT_EQ(with({"scene.name=\"other one\""}).name, "other one");
}

TEST(Overrides, EntriesByIndexByNameAndAll) {
    const Scene by_index = with({"cloth[1].density=9"});
    EXPECT_EQ(by_index.cloths[0].density, 0.2);
    EXPECT_EQ(by_index.cloths[1].density, 9.0);
    const Scene by_name = with({"cloth.tube.density=9"});
    EXPECT_EQ(by_name.cloths[0].density, 0.2);
    EXPECT_EQ(by_name.cloths[1].density, 9.0);
    const Scene all = with({"cloth.density=9"});
    EXPECT_EQ(all.cloths[0].density, 9.0);
    EXPECT_EQ(all.cloths[1].density, 9.0);
}

TEST(Overrides, ListsAndTheirEntries) {
    const Scene scene = with({"cloth[0].grid.resolution=[40, 50]", "cloth[0].grid.size[1]=7"});
    const auto& grid = std::get<GridShape>(scene.cloths[0].shape);
    EXPECT_EQ(grid.resolution, (std::array{40, 50}));
    EXPECT_EQ(grid.size, (std::array{1.0, 7.0}));
}

TEST(Overrides, AddWhatTheSceneLeftOut) {
    const Scene scene = with({"cloth.tube.bend.stiffness=0.5", "cloth.sheet.pins=[]"});
    ASSERT_TRUE(scene.cloths[1].bend);
    EXPECT_EQ(scene.cloths[1].bend->stiffness, 0.5);
    EXPECT_TRUE(scene.cloths[0].pins.empty());
}

TEST(Overrides, WholeTables) {
    EXPECT_TRUE(with({"obstacle=[]"}).obstacles.empty());
    EXPECT_EQ(with({"solver={iterations=77}"}).solver.iterations, 77);
}

TEST(Overrides, MistakesNameTheCommandLine) {
    EXPECT_EQ(message_of("scene.frames=0"),
              "--set scene.frames=0: scene.frames = 0: must be at least 1");
    EXPECT_EQ(message_of("scene.framez=3"),
              "--set scene.framez=3: unknown key 'framez' in scene; did you mean 'frames'?");
    EXPECT_NE(message_of("scene.frames").find("expected table.key=value"), std::string::npos);
    EXPECT_NE(message_of("=3").find("expected table.key=value"), std::string::npos);
    EXPECT_NE(message_of("scene..dt=3").find("expected table.key=value"), std::string::npos);
    EXPECT_NE(message_of("cloth[9].density=3").find("the list has 3 entries"), std::string::npos);
    EXPECT_NE(message_of("cloth[x].density=3").find("expected an index"), std::string::npos);
    EXPECT_NE(message_of("cloth[0.density=3").find("']' is missing"), std::string::npos);
    EXPECT_NE(message_of("scene[0]=3").find("there is no list here"), std::string::npos);
    EXPECT_NE(message_of("scene.dt.x=3").find("cannot be set inside 0.02"), std::string::npos);
    EXPECT_NE(message_of("scene.dt=[1").find("not valid TOML"), std::string::npos);
    const std::string spaced = message_of("scene.name=two words");
    EXPECT_NE(spaced.find("not valid TOML"), std::string::npos) << spaced;
    EXPECT_NE(spaced.find("a text like this needs quotes"), std::string::npos) << spaced;
    EXPECT_EQ(message_of("scene.dt=[1").find("quotes"), std::string::npos);
    EXPECT_NE(message_of("scene.name=\xe9").find("not valid TOML"), std::string::npos);
    EXPECT_NE(message_of("scene.dt=").find("not valid TOML"), std::string::npos);
    EXPECT_NE(message_of("scene.dt=1\nx=2").find("one value"), std::string::npos);
}

}  // namespace
}  // namespace weft
