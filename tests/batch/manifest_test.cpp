#include "apps/weft/batch/manifest.h"

#include <fstream>
#include <sstream>

#include "sweep_text.h"

namespace weft::batch {
namespace {

Run make_run(std::size_t index, const std::string& id) {
    Run run;
    run.index = index;
    run.id = id;
    run.scene = "../a \"b\".toml";
    run.scene_hash = "h";
    run.values = {{"z.y", 1.5}, {"a.b", "text\n"}};
    run.arguments = {"--set", "z.y=1.5"};
    return run;
}

class ManifestFile : public InFolder {};

TEST_F(ManifestFile, IsReadBack) {
    Manifest manifest{
        "n", "run", "1", "../s.toml", "text\n\"x\"", 60.0, {make_run(0, "a"), make_run(1, "b")}};
    manifest.runs[1].dropped = true;
    write_manifest(folder_, manifest);
    const Manifest back = read_manifest(folder_);
    EXPECT_EQ(to_jsonl(back), to_jsonl(manifest));
    EXPECT_EQ(back.runs[0].values[0].first, "z.y");  // in the sweep's order
    EXPECT_EQ(back.current(), (std::vector<std::size_t>{0}));
}

TEST_F(ManifestFile, RefusesWhatIsNone) {
    EXPECT_NE(message_of([&] { read_manifest(folder_); }).find("is not there"), std::string::npos);
    const auto refused = [&](const std::string& text) {
        write("manifest.jsonl", text);
        return message_of([&] { read_manifest(folder_); });
    };
    EXPECT_NE(refused("").find("empty"), std::string::npos);
    EXPECT_NE(refused("x\n").find("manifest.jsonl:1: this line cannot be read"), std::string::npos);
    EXPECT_NE(refused("x\n").find("make the sweep again"), std::string::npos);
    EXPECT_EQ(refused("x\n").find("exception"), std::string::npos);
    EXPECT_NE(refused("{\"format\": \"other\"}\n").find("no manifest"), std::string::npos);
    // Cut off in the middle.
    const std::string whole =
        to_jsonl(Manifest{"n", "run", "1", "", "", {}, {make_run(0, "a"), make_run(1, "b")}});
    EXPECT_NE(refused(whole.substr(0, whole.size() - 5)).find("manifest.jsonl:3: this line cannot"),
              std::string::npos);
    EXPECT_NE(refused(whole.substr(0, whole.find("\n{\"index\":1") + 1)).find("says 2"),
              std::string::npos);
}

TEST_F(ManifestFile, BelongsToTheSweepFileThatMadeIt) {
    Manifest manifest;
    manifest.name = "n";
    manifest.file = "../a.toml";
    const auto folder = folder_ / "n";
    const std::string a = write("a.toml", ""), b = write("b.toml", "");
    std::filesystem::create_directories(folder);
    EXPECT_NO_THROW(check_made_by(manifest, folder, a));
    const std::string wrong = message_of([&] { check_made_by(manifest, folder, b); });
    EXPECT_EQ(wrong.find(b + ": "), 0U) << wrong;
    EXPECT_NE(wrong.find("the folder of " + a), std::string::npos) << wrong;
    // A file that was given another name is still the same sweep.
    std::filesystem::remove(a);
    EXPECT_NO_THROW(check_made_by(manifest, folder, b));
}

TEST(Merged, OldRunsKeepTheirNumbers) {
    const std::vector<batch::Run> before{make_run(0, "a"), make_run(1, "b"), make_run(2, "c")};
    const auto runs = merged(before, {make_run(0, "d"), make_run(1, "c"), make_run(2, "a")});
    ASSERT_EQ(runs.size(), 4U);
    const std::vector<std::string> ids{"a", "b", "c", "d"};
    for (std::size_t i = 0; i < runs.size(); ++i) {
        EXPECT_EQ(runs[i].index, i);
        EXPECT_EQ(runs[i].id, ids[i]);
        EXPECT_EQ(runs[i].dropped, i == 1);
    }
    // What was dropped comes back under its old number.
    EXPECT_FALSE(merged(runs, {make_run(0, "b")})[1].dropped);
}

}  // namespace
}  // namespace weft::batch
