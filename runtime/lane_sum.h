#pragma once

#include <array>
#include <cstddef>
#include <numeric>
#include <span>

// Host loops that compilers turn into vector instructions, with the same bits on every machine.

/// In front of a function: it and all that it calls are compiled for wider registers, too, and the
/// machine's own are chosen when the program starts. (Sanitizers are not ready yet when it does.)
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__ELF__) && \
    !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
#define WEFT_WIDE \
    __attribute__((flatten, target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define WEFT_WIDE
#endif

namespace weft {

/// What lanes that take turns have put together. One order, whatever the registers; but no term
/// waits for what was made of the last one.
template <class Operation>
class InLanes {
public:
    void add(std::span<const double> terms) {
        constexpr Operation join;
        std::size_t i = 0;
        for (; i + kLanes <= terms.size(); i += kLanes) {
            for (std::size_t k = 0; k < kLanes; ++k) lanes_[k] = join(lanes_[k], terms[i + k]);
        }
        for (std::size_t k = 0; i < terms.size(); ++i, ++k) lanes_[k] = join(lanes_[k], terms[i]);
    }

    double total() const {
        constexpr Operation join;
        return std::accumulate(lanes_.begin() + 1, lanes_.end(), lanes_.front(), join);
    }

private:
    static constexpr std::size_t kLanes = 8;
    std::array<double, kLanes> lanes_{};
};

struct Plus {
    double operator()(double a, double b) const { return a + b; }
};
struct Larger {
    double operator()(double a, double b) const { return a > b ? a : b; }
};

using LaneSum = InLanes<Plus>;
using LaneMaximum = InLanes<Larger>;  ///< of what is not negative

}  // namespace weft
