#pragma once

#include <array>
#include <initializer_list>
#include <span>

#include "scheduler/assert.h"

namespace weft {

/// What an entry of a table has, one number per column. Tables have entries by the million, so
/// there is nothing to allocate.
class FewNumbers {
public:
    FewNumbers() = default;
    FewNumbers(std::initializer_list<double> numbers) : FewNumbers(std::span(numbers)) {}
    explicit FewNumbers(std::span<const double> numbers) {
        for (const double number : numbers) push_back(number);
    }

    void push_back(double number) {
        WEFT_ASSERT(count_ < numbers_.size());
        numbers_[count_++] = number;
    }
    const double* begin() const { return numbers_.data(); }
    const double* end() const { return numbers_.data() + count_; }

private:
    std::array<double, 16> numbers_{};
    std::size_t count_ = 0;
};

}  // namespace weft
