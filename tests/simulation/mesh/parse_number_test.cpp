#include "simulation/mesh/parse_number.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace weft::test {
namespace {

using Parser = std::optional<double> (*)(std::string_view);

/// Both ways, whichever the standard library at hand takes.
class ParseNumber : public testing::TestWithParam<Parser> {};

TEST_P(ParseNumber, TakesNumbers) {
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    const std::pair<const char*, double> numbers[] = {
        {"0", 0.0},
        {"-1.5", -1.5},
        {"+2", 2.0},
        {".5", 0.5},
        {"5.", 5.0},
        {"1e3", 1e3},
        {"1E-3", 1e-3},
        {"0.1", 0.1},
        {"1e400", kInfinite},
        {"1e-400", 0.0},
        {"inf", kInfinite},
        {"-inf", -kInfinite},
        {"4.9406564584124654e-324", std::numeric_limits<double>::denorm_min()}};
    for (const auto& [word, value] : numbers) EXPECT_EQ(GetParam()(word), value) << word;
    for (const char* word : {"nan", "-nan", "NaN"}) {
        const std::optional<double> value = GetParam()(word);
        EXPECT_TRUE(value && std::isnan(*value)) << word;
    }
}

TEST_P(ParseNumber, RefusesWhatIsNone) {
    for (const char* word : {"", "abc", "-", "+", ".", "e5", "1e", "1x", "1 ", " 1", "1,5", "++1",
                             "+-1", "--1", "-+1", "0x10", "1.2.3", "infinite", "nanometre"}) {
        EXPECT_EQ(GetParam()(word), std::nullopt) << "'" << word << "'";
    }
    EXPECT_EQ(GetParam()(std::string_view("1\0", 2)), std::nullopt);
    EXPECT_EQ(GetParam()(std::string_view("12", 1)), 1.0) << "it ends where the word ends";
}

INSTANTIATE_TEST_SUITE_P(Ways, ParseNumber,
                         testing::Values(&parse_number, &parse_number_by_strtod));

}  // namespace
}  // namespace weft::test
