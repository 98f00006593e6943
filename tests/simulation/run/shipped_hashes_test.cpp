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
    {"beams", Method::kXpbd, "a2873b8680f776c1f2c8ec683d4ed7f2"},
    {"beams", Method::kVbd, "d35da203e88f0f8e0f9722139d61c957"},
    {"beams", Method::kSosd, "e59a7841b0bf9783284166f2393afe36"},
    {"beams", Method::kJpgd, "bbcbd186ecb4818f25c30d06026990a0"},
    {"beams", Method::kNewton, "f54c55efaa877e079c91c09c392facf3"},
    {"hammock", Method::kXpbd, "af152f4766fd8820b8554038bb58b28c"},
    {"hammock", Method::kVbd, "536463dd0ccc5e698c4141538926075f"},
    {"hammock", Method::kSosd, "f95c507622fbe8f2971bd526723c126e"},
    {"hammock", Method::kJpgd, "8bedba7de7d1ed0a764d51afe4aa884b"},
    {"hammock", Method::kNewton, "2645fc063bc1d5eacc9e9bc9c611a30a"},
    {"tablecloth", Method::kXpbd, "ac3803c8a2f370300f5316c7ccd3d25a"},
    {"tablecloth", Method::kVbd, "19058c1ffec7af0c8ab0769cd57483f6"},
    {"tablecloth", Method::kSosd, "8076ed7a23ebabd78aab7e69c5a87702"},
    {"tablecloth", Method::kJpgd, "a010cc25ef2989a6856b81fabb2b2f0d"},
    {"tablecloth", Method::kNewton, "5c10ae56133e85d287137bb568512ffe"},
    {"skirt", Method::kXpbd, "1f941d1519eb5440eb22682f11f852b4"},
    {"skirt", Method::kVbd, "548746c1e10ce4ca774362deaca420d9"},
    {"skirt", Method::kSosd, "02e0357fea43fee11bb7e2193632af8d"},
    {"skirt", Method::kJpgd, "c1aef98dae32dc63f55a110a9ac94835"},
    {"skirt", Method::kNewton, "9e679995d207f99ee25ed642657381d9"},
    {"flag", Method::kXpbd, "a1b2837b9bc6093172a7360b6c1d9367"},
    {"flag", Method::kVbd, "c0a02ce315122c4043727bdb749d1e88"},
    {"flag", Method::kSosd, "89d7f4c2cac03affc7ccdf24726649e9"},
    {"flag", Method::kJpgd, "06306c21624b79ec8d3dd2a86034e903"},
    {"flag", Method::kNewton, "4e3033d35c5a7a9e58f5c70985ceaaef"},
    {"pillows", Method::kVbd, "ae24df3a44ff8f5ef9e6ab92b1870c1f"},
    {"funnel", Method::kVbd, "28fd5c4397a3f85a2e78a500f30a94a5"},
    {"dress", Method::kVbd, "f981ddbff7d1371a152fb0f7fdadbc22"},
    {"jersey", Method::kVbd, "c07ed074a0ce0647acd5890868a4d6b4"},
    {"letters", Method::kVbd, "346ad5384e2b1ab9e4041208fe25cf84"},
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
    scene.cloths[0].bend->rest_is_flat = true;
    EXPECT_EQ(hash_after_two_frames(scene), kOld.at(GetParam().method));
}

INSTANTIATE_TEST_SUITE_P(Scenes, ShippedScenes, testing::ValuesIn(kShipped), [](const auto& given) {
    return std::string(given.param.scene) + "_" + std::string(name_of(given.param.method));
});

}  // namespace
}  // namespace weft::test
