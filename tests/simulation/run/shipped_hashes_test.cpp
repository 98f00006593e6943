// What the shipped scenes come to, by every solver: their first two frames on one core.

#include <gtest/gtest.h>

#include <map>

#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"

namespace weft::test {
namespace {

struct Shipped {
    const char* scene;
    Method method;
    /// Where results are meant to change, copy the new one from the message, and say in the change
    /// log that they changed.
    const char* hash;
};

const Shipped kShipped[] = {
    {"sheet", Method::kXpbd, "587ebaa97dea1eab7ecf46db7d8775de"},
    {"sheet", Method::kVbd, "e9e31b742685f87b65db2bc063c08bd6"},
    {"sheet", Method::kSosd, "59483b009a0b0997175457289611041e"},
    {"sheet", Method::kJpgd, "ff21e08de3f0394de4404529a51972fb"},
    {"sheet", Method::kNewton, "cb74acb6cca021d6d3c45ed415a8d979"},
    {"beams", Method::kXpbd, "f1a119f789ecafb9d49ba895d1501aca"},
    {"beams", Method::kVbd, "a7da04a69fc31888492f36ca6c924a2a"},
    {"beams", Method::kSosd, "ef25e95215a192bd9d03fdb3ee3b8116"},
    {"beams", Method::kJpgd, "c7eeb9e2e4e0d7f953760fbaadf4e1a7"},
    {"beams", Method::kNewton, "86f36cf4bc55cfbe47b3bda0d993531b"},
    {"hammock", Method::kXpbd, "d13912fb8a18241c2dfa782ae3c1e5a4"},
    {"hammock", Method::kVbd, "473ca9699cb1050937a890754d1834e5"},
    {"hammock", Method::kSosd, "ede50a4ec99fb3ef426fe6f48370914b"},
    {"hammock", Method::kJpgd, "98b78c5bdf1c06dfde3960672f292a21"},
    {"hammock", Method::kNewton, "ef278721b7ea195b4a765ccdd76b081a"},
    {"tablecloth", Method::kXpbd, "f121fc77720927c574ff3ff51cf781fc"},
    {"tablecloth", Method::kVbd, "85660b3c0892fa67f884006c1fa236da"},
    {"tablecloth", Method::kSosd, "010e60bc6e762ab4a05ed74c8a24746a"},
    {"tablecloth", Method::kJpgd, "0015001a405095798f641faa73c33239"},
    {"tablecloth", Method::kNewton, "2cab8546123e8ca8903eb995dc6550ef"},
    {"skirt", Method::kXpbd, "7ea3000ee403f0f0f6c5a6f684537eb1"},
    {"skirt", Method::kVbd, "a89fd9f3cd65bd91f55a9b93cfa00ac1"},
    {"skirt", Method::kSosd, "23b4693b985038567578d9d910dff052"},
    {"skirt", Method::kJpgd, "ec1921e6d5e5277b1f630dc2ab785986"},
    {"skirt", Method::kNewton, "a2902d1f9077c3c3f86f6ec123b9bfdf"},
    {"flag", Method::kXpbd, "fd289833fad03bdee7ea41503b7befbf"},
    {"flag", Method::kVbd, "37814c135736f89458c32d8a88d9865c"},
    {"flag", Method::kSosd, "4b55f489b50532bfffe2d67521084266"},
    {"flag", Method::kJpgd, "db12634aed819f901840430bb22e0813"},
    {"flag", Method::kNewton, "b642a2e6d59816674df109d1daca8f7a"},
    {"pillows", Method::kVbd, "2034206d0cc824f0f3fdf408fc1f930d"},
    {"funnel", Method::kVbd, "0ed44d13dabc978c9155b9b77a32cf4e"},
    {"dress", Method::kVbd, "3b2efe3baa8beaac8562d988af5d685b"},
    {"jersey", Method::kVbd, "c07ed074a0ce0647acd5890868a4d6b4"},
    {"letters", Method::kVbd, "78518667a5dd248af47ee4c91a35561f"},
};

std::string hash_after_two_frames(const Scene& scene) {
    Warnings warnings;
    SimulationOptions options;
    options.devices = "cpu/1";
    Simulation simulation(scene, options, warnings);
    for (int frame = 0; frame < 2; ++frame) simulation.advance();
    return simulation.hash();
}

class ShippedScenes : public testing::TestWithParam<Shipped> {};

TEST_P(ShippedScenes, HaveTheirHash) {
#ifndef __linux__
    GTEST_SKIP() << "the sines of other C libraries are rounded otherwise";
#endif
    Scene scene = read_scene(std::string(WEFT_SCENES) + "/" + GetParam().scene + ".toml");
    scene.solver.method = GetParam().method;
    EXPECT_EQ(hash_after_two_frames(scene), GetParam().hash);
}

/// Bending that is flat at rest is what it was before rest shapes could be curved.
TEST_P(ShippedScenes, SkirtWithFlatRestHasItsOldHash) {
#ifndef __linux__
    GTEST_SKIP() << "the sines of other C libraries are rounded otherwise";
#endif
    const std::map<Method, std::string> kOld{{Method::kXpbd, "9fa93d78767c8aff2bb3b57a39d685dd"},
                                             {Method::kVbd, "fa02ffa093edead71a3f28bc34f1d748"},
                                             {Method::kSosd, "45c9e8f491e8984142736f95dfd2222d"},
                                             {Method::kJpgd, "31cde050c5ace9d7826bd82f53241e90"},
                                             {Method::kNewton, "5879fc8b97e8a5360191e0be7f748a5e"}};
    if (std::string(GetParam().scene) != "skirt") return;
    Scene scene = read_scene(std::string(WEFT_SCENES) + "/skirt.toml");
    scene.solver.method = GetParam().method;
    scene.substeps = 10;  // as it had then
    scene.solver.iterations = 8;
    scene.cloths[0].bend->rest_is_flat = true;
    EXPECT_EQ(hash_after_two_frames(scene), kOld.at(GetParam().method));
}

INSTANTIATE_TEST_SUITE_P(Scenes, ShippedScenes, testing::ValuesIn(kShipped), [](const auto& given) {
    return std::string(given.param.scene) + "_" + std::string(name_of(given.param.method));
});

}  // namespace
}  // namespace weft::test
