#include "simulation/mesh/parse_number.h"

#include <locale.h>
#include <stdlib.h>
#ifdef __APPLE__
#include <xlocale.h>
#endif

#include <charconv>
#include <limits>
#include <string>
#include <version>

namespace weft {
namespace {

/// The word without a plus; nothing where another sign follows.
std::string_view without_plus(std::string_view word) {
    if (!word.starts_with('+')) return word;
    word.remove_prefix(1);
    return word.starts_with('-') ? std::string_view() : word;
}

}  // namespace

std::optional<double> parse_number(std::string_view word) {
#if defined(__cpp_lib_to_chars)
    word = without_plus(word);
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (end != word.data() + word.size() || error == std::errc::invalid_argument) return {};
    if (error == std::errc{}) return value;
    const bool is_small = word.find("e-") != word.npos || word.find("E-") != word.npos;
    return is_small ? 0.0 : std::numeric_limits<double>::infinity();
#else
    return parse_number_by_strtod(word);
#endif
}

std::optional<double> parse_number_by_strtod(std::string_view word) {
    // strtod takes more than from_chars does: blanks before a number, and hexadecimal ones.
    constexpr const char* kFirst = "-.0123456789iInN";
    word = without_plus(word);
    if (word.empty() || std::string_view(kFirst).find(word.front()) == word.npos) return {};
    if (word.find_first_of("xX") != word.npos) return {};
    static const locale_t plain = ::newlocale(LC_ALL_MASK, "C", nullptr);
    const std::string text(word);
    char* end = nullptr;
    const double value = ::strtod_l(text.c_str(), &end, plain);
    if (end != text.c_str() + text.size()) return {};
    return value;
}

}  // namespace weft
