// Thousands of broken scenes: each is read or refused with UserError, and nothing else happens.
#include <random>

#include <gtest/gtest.h>

#include "runtime/error.h"
#include "scene_text.h"
#include "simulation/scene/read_scene.h"
#include "tests/mutation.h"

namespace weft {
namespace {

const char* const kPieces[] = {"-1",        "0",
                               "1e999",     "nan",
                               "inf",       "\"\"",
                               "[]",        "{}",
                               "[[]]",      "true",
                               "\n",        "=",
                               "[",         "]]",
                               ",",         "1979-05-27",
                               "\0x",       "\"",
                               "#",         "cloth",
                               "[[cloth]]", "9223372036854775807"};

/// Replaces the value of one line: broken TOML hides mistakes of meaning, this finds those.
std::string with_other_value(std::string text, std::mt19937& random) {
    const std::size_t equals = text.find(" = ", random() % text.size());
    if (equals == std::string::npos) return text;
    const std::size_t end = text.find_first_of(",}\n", equals);
    return text.replace(equals + 3, end - equals - 3, kPieces[random() % std::size(kPieces)]);
}

void read_or_refuse(const std::string& text) {
    try {
        parse_scene(text, "fuzz.toml");
    } catch (const UserError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
}

TEST(SceneFuzz, MutatedTextIsReadOrRefused) {
    std::mt19937 random(1);
    for (int i = 0; i < 2000; ++i) read_or_refuse(test::mutated(test::kFullScene, random, kPieces));
}

TEST(SceneFuzz, OddValuesAreReadOrRefused) {
    std::mt19937 random(2);
    for (int i = 0; i < 2000; ++i) read_or_refuse(with_other_value(test::kFullScene, random));
}

TEST(SceneFuzz, MutatedOverridesAreReadOrRefused) {
    std::mt19937 random(3);
    const std::string path = "cloth[1].pins[0].motion.keyframes[1].translate=[0.0, 1.0, 0.0]";
    for (int i = 0; i < 2000; ++i) {
        try {
            parse_scene(test::kFullScene, "s.toml",
                        {{test::mutated(path, random, kPieces), "--set"}});
        } catch (const UserError&) {
        }
    }
}

}  // namespace
}  // namespace weft
