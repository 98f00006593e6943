#include "runtime/near_miss.h"

#include <algorithm>
#include <cctype>
#include <numeric>

namespace weft {
namespace {

// Beyond this nobody mistyped, and the quadratic search would only cost time.
constexpr std::size_t kMaxWord = 64;

char folded(char c) {
    return c == '-' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

/// Levenshtein distance, blind to case and to '-' against '_'; a swap of neighbours costs 1.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    std::iota(last.begin(), last.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const bool same = folded(a[i - 1]) == folded(b[j - 1]);
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0U : 1U)});
            const bool swapped = i > 1 && j > 1 && folded(a[i - 1]) == folded(b[j - 2]) &&
                                 folded(a[i - 2]) == folded(b[j - 1]);
            if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before.swap(last);
        last.swap(row);
    }
    return last[b.size()];
}

}  // namespace

std::string near_miss(std::string_view word, const std::vector<std::string>& candidates) {
    if (word.empty() || word.size() > kMaxWord) return "";
    const std::string* best = nullptr;
    std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
    for (const std::string& candidate : candidates) {
        const std::size_t distance = edit_distance(word, candidate);
        if (distance >= best_distance) continue;
        best_distance = distance;
        best = &candidate;
    }
    return best ? "did you mean '" + *best + "'?" : "";
}

std::string near_miss_or_list(std::string_view word, const std::vector<std::string>& candidates) {
    const std::string near = near_miss(word, candidates);
    if (!near.empty()) return near;
    std::string known = "known: ";
    for (const std::string& candidate : candidates) {
        known += (&candidate == candidates.data() ? "" : ", ") + candidate;
    }
    return known;
}

}  // namespace weft
