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
    {"sheet", Method::kVbd, "0dde1e5a80a085dab59a1d0c39e6ce3d"},
    {"sheet", Method::kSosd, "351018342033c098dea001a51ae22d50"},
    {"sheet", Method::kJpgd, "6c88dc495339b3f516ded6d817cfda83"},
    {"sheet", Method::kNewton, "0235586c46029a0176cf64e5d86bdfaa"},
    {"beams", Method::kXpbd, "f1a119f789ecafb9d49ba895d1501aca"},
    {"beams", Method::kVbd, "d35da203e88f0f8e0f9722139d61c957"},
    {"beams", Method::kSosd, "e59a7841b0bf9783284166f2393afe36"},
    {"beams", Method::kJpgd, "bbcbd186ecb4818f25c30d06026990a0"},
    {"beams", Method::kNewton, "f54c55efaa877e079c91c09c392facf3"},
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
    {"flag", Method::kVbd, "caa86c7d736e6b756a68d4eb1c304495"},
    {"flag", Method::kSosd, "33c38c5e226251f6a7d8b245937cb952"},
    {"flag", Method::kJpgd, "fabb17beef528fcb0fa18e5117acabdf"},
    {"flag", Method::kNewton, "9b654375a95910b372bf458e07b9281c"},
    {"pillows", Method::kVbd, "cf00f8b0828b93b9df8e7f2d0f498032"},
    {"funnel", Method::kVbd, "28fd5c4397a3f85a2e78a500f30a94a5"},
    {"dress", Method::kVbd, "bd1b623616d12cc694d8c4949e7f9d05"},
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
