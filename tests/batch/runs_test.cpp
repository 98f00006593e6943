#include "apps/weft/batch/runs.h"

#include <algorithm>
#include <set>

#include "sweep_text.h"

namespace weft::batch {
namespace {

class Runs : public InFolder {
protected:
    void SetUp() override {
        InFolder::SetUp();
        write("scene.toml", kScene);
    }

    std::vector<batch::Run> make(const std::string& text) const {
        const std::string path = write("s.toml", kHead + text);
        const CommandLine command_line{
            {{"device", false}, {"plan", false}, {"strips", false}, {"geometry", true}},
            [](const std::vector<std::string>& options) {
                if (std::ranges::find(options, "cpux") != options.end()) throw UserError("no cpux");
            }};
        return runs_of(read_sweep(path), folder_ / "out/s", command_line);
    }

    std::string refused(const std::string& text) const {
        return message_of([&] { make(text); });
    }
};

const char* const kTwoAxes = R"(
run = { device = "cpu/1", geometry = false, strips = [1, 2] }
[[axis]]
key = "scene.substeps"
values = [1, 2]
[[axis]]
key = "run.plan"
values = ["auto", "single"]
)";

TEST_F(Runs, AreCommandsOfTheProgram) {
    const auto runs = make(kTwoAxes);
    ASSERT_EQ(runs.size(), 4U);
    EXPECT_EQ(runs[3].arguments,
              (std::vector<std::string>{"--device", "cpu/1", "--no-geometry", "--strips", "1,2",
                                        "--plan", "single", "--set", "scene.substeps=2"}));
    EXPECT_EQ(runs[3].scene, "../../scene.toml");
    ASSERT_EQ(runs[3].values.size(), 2U);
    EXPECT_EQ(runs[3].values[1].first, "run.plan");
    std::set<std::string> ids;
    for (const batch::Run& run : runs) {
        EXPECT_EQ(run.id.size(), 12U);
        ids.insert(run.id);
    }
    EXPECT_EQ(ids.size(), 4U);
}

TEST_F(Runs, KeepTheirIdsHoweverTheSweepGrows) {
    const auto before = make("[[axis]]\nkey = \"scene.substeps\"\nvalues = [1, 2]\n");
    const auto after = make("[[axis]]\nkey = \"scene.substeps\"\nvalues = [3, 2, 1]\n");
    EXPECT_EQ(before[0].id, after[2].id);
    EXPECT_EQ(before[1].id, after[1].id);
    EXPECT_NE(before[0].id, after[0].id);
}

TEST_F(Runs, ChangeTheirIdsWithTheScene) {
    const char* axis = "[[axis]]\nkey = \"scene.substeps\"\nvalues = [1]\n";
    const auto before = make(axis);
    write("scene.toml", std::string(kScene) + "# a word\n");
    EXPECT_NE(before[0].id, make(axis)[0].id);
}

TEST_F(Runs, RepeatsAreRunsOfTheirOwn) {
    EXPECT_EQ(make("[[axis]]\nkey = \"run.repeat\"\nvalues = [1, 2]\n").size(), 2U);
    EXPECT_NE(refused("[[axis]]\nkey = \"scene.substeps\"\nvalues = [1, 1]\n").find("run.repeat"),
              std::string::npos);
}

TEST_F(Runs, EveryPointIsReadAsAScene) {
    const std::string wrong =
        refused("[[axis]]\nkey = \"solver.method\"\nvalues = [\"xpbd\", \"xbpd\"]\n");
    EXPECT_NE(wrong.find("s.toml:4:19"), std::string::npos) << wrong;
    EXPECT_NE(wrong.find("xpbd"), std::string::npos) << wrong;
    EXPECT_NE(refused("[[axis]]\nkey = \"scene.sustbeps\"\nvalues = [1]\n").find("substeps"),
              std::string::npos);
}

TEST_F(Runs, OptionsAreChecked) {
    // At the option that is wrong, though its message does not name it.
    const std::string wrong = refused("run = { device = \"cpux\", plan = \"auto\" }\n");
    EXPECT_NE(wrong.find("s.toml:2:9"), std::string::npos) << wrong;
    EXPECT_NE(refused("run = { geometry = 1 }\n").find("expected true or false"),
              std::string::npos);
    EXPECT_NE(refused("run = { device = false }\n").find("expected a value"), std::string::npos);
    EXPECT_NE(refused("run = { frames = 1 }\n").find("use an axis on scene.frames"),
              std::string::npos);
    EXPECT_NE(refused("run = { out = \"x\" }\n").find("folders"), std::string::npos);
}

TEST_F(Runs, MisspeltOptionsAreFoundThoughTheyAreFalse) {
    for (const char* value : {"false", "true", "1"}) {
        const std::string wrong =
            refused(std::string("run = { plan = \"auto\", geometri = ") + value + " }\n");
        EXPECT_NE(wrong.find("s.toml:2:24: unknown key 'run.geometri'"), std::string::npos)
            << wrong;
        EXPECT_NE(wrong.find("'run.geometry'"), std::string::npos) << wrong;
    }
}

TEST_F(Runs, ScenesMayBeAnAxis) {
    write("other.toml", std::string(kScene) + "# other\n");
    const auto runs =
        make("[[axis]]\nkey = \"sweep.scene\"\nvalues = [\"scene.toml\", \"other.toml\"]\n");
    EXPECT_EQ(runs[1].scene, "../../other.toml");
    EXPECT_NE(runs[0].id, runs[1].id);
    EXPECT_NE(refused("[[axis]]\nkey = \"sweep.scene\"\nvalues = [\"none.toml\"]\n")
                  .find("none.toml: no such"),
              std::string::npos);
    EXPECT_NE(refused("[[axis]]\nkey = \"sweep.scene\"\nvalues = [\"none.toml\"]\n")
                  .find("s.toml:4:11: "),
              std::string::npos);
}

}  // namespace
}  // namespace weft::batch
