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
    {"hammock", Method::kVbd, "ad17686a9281fc30f4777270dedf0e81"},
    {"hammock", Method::kSosd, "30c248e33e709c5cd156848b812a9d4e"},
    {"hammock", Method::kJpgd, "489b1ff65235f29a7736f5b258f09bc8"},
    {"hammock", Method::kNewton, "131a44cf3513bca17a1ff4dcd9b0fc31"},
    {"tablecloth", Method::kXpbd, "f121fc77720927c574ff3ff51cf781fc"},
    {"tablecloth", Method::kVbd, "85660b3c0892fa67f884006c1fa236da"},
    {"tablecloth", Method::kSosd, "010e60bc6e762ab4a05ed74c8a24746a"},
    {"tablecloth", Method::kJpgd, "0015001a405095798f641faa73c33239"},
    {"tablecloth", Method::kNewton, "2cab8546123e8ca8903eb995dc6550ef"},
    {"skirt", Method::kXpbd, "7ea3000ee403f0f0f6c5a6f684537eb1"},
    {"skirt", Method::kVbd, "ed8cdd07b6ba0899c17e99000c152f31"},
    {"skirt", Method::kSosd, "fc69233f6c6a99e6fc0e7f9dd6e1e948"},
    {"skirt", Method::kJpgd, "696d4a900cc94ad09d339d95628829ae"},
    {"skirt", Method::kNewton, "6db76fc7709c1378a92e15f4dfc5f4f0"},
    {"flag", Method::kXpbd, "fd289833fad03bdee7ea41503b7befbf"},
    {"flag", Method::kVbd, "7b8db9a4a86ea178c4d9cf5ab8784e9a"},
    {"flag", Method::kSosd, "5ce9d2234ae3b47f12bc8709aabe6e04"},
    {"flag", Method::kJpgd, "12599100755be6a2557b07c296b1c278"},
    {"flag", Method::kNewton, "b57dbae13fd76990bb9a8fff7b7ebf00"},
    {"pillows", Method::kVbd, "fe78df51469a3e372ecf077217e038fb"},
    {"funnel", Method::kVbd, "0ed44d13dabc978c9155b9b77a32cf4e"},
    {"dress", Method::kVbd, "a8f39b4960962cb38b4c319b41970627"},
    {"jersey", Method::kVbd, "c07ed074a0ce0647acd5890868a4d6b4"},
    {"letters", Method::kVbd, "cada116950a0f7b54293717b1b57ebc0"},
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
                                             {Method::kVbd, "df3fd301e2891bc14fcbab03fb24ebda"},
                                             {Method::kSosd, "a757e79f8293384321b3cd3da3c1f598"},
                                             {Method::kJpgd, "e3da0ce8bbd8708cb24be8153672a9ab"},
                                             {Method::kNewton, "0d0f5b69d667bdc91ad3c977f50311c0"}};
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
