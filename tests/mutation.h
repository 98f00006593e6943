#pragma once

#include <cstddef>
#include <random>
#include <span>
#include <string>

namespace weft::test {

/// Makes up to four random changes to a text: something left out, one of the `pieces` put in, a
/// part repeated elsewhere, or one byte replaced. For tests that throw broken files at readers.
inline std::string mutated(std::string text, std::mt19937& random,
                           std::span<const char* const> pieces) {
    const auto below = [&](std::size_t n) { return n == 0 ? 0 : random() % n; };
    const std::size_t changes = 1 + below(4);
    for (std::size_t i = 0; i < changes; ++i) {
        const std::size_t at = below(text.size());
        switch (below(4)) {
            case 0:
                text.erase(at, 1 + below(12));
                break;
            case 1:
                text.insert(at, pieces[below(pieces.size())]);
                break;
            case 2:
                text.insert(at, text.substr(below(text.size()), below(60)));
                break;
            default:
                if (!text.empty()) text[at] = static_cast<char>(below(256));
        }
    }
    return text;
}

}  // namespace weft::test
