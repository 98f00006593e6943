// All forms of one kernel that this processor can run give the same bits: scalar, packed for the
// baseline, packed for better instructions.

#include <gtest/gtest.h>

#include <cstdint>
#include <set>

#include "kernels/registry.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

constexpr int kInstance = 1;

/// A case after items [begin, items) have been run by one form.
std::unique_ptr<KernelCase> result_of(const kernels::KernelInfo& kernel,
                                      kernels::RangeFunction function, int items, int begin,
                                      Flavour flavour) {
    auto made = make_case(kernel.name, items, flavour, static_cast<unsigned>(items));
    run_on_host(made->launch, function, begin, items, kInstance);
    return made;
}

class EveryKernel : public testing::TestWithParam<const kernels::KernelInfo*> {};

TEST_P(EveryKernel, HasATestCase) {
    EXPECT_NE(make_case(GetParam()->name, 1, Flavour::kRandom, 1), nullptr)
        << "add " << GetParam()->name << " to a new tests/kernels/*_cases.cpp";
}

TEST_P(EveryKernel, HasTheSameBitsInAllForms) {
    const kernels::KernelInfo& kernel = *GetParam();
    ASSERT_NE(kernel.scalar, nullptr);
    ASSERT_TRUE(kernel.packed_forms.contains(kernels::Target::kPacked));
    ASSERT_EQ(kernel.form(kernels::widest_pack()), kernel.packed_forms.rbegin()->second);
    for (const Flavour flavour : {Flavour::kRandom, Flavour::kDegenerate}) {
        for (const int items :
             {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 23, 31, 150}) {
            for (const int begin : {0, items / 3}) {
                SCOPED_TRACE(testing::Message() << "items " << begin << " to " << items);
                const auto scalar = result_of(kernel, kernel.scalar, items, begin, flavour);
                expect_finite(*scalar);
                for (const auto& [target, function] : kernel.packed_forms) {
                    SCOPED_TRACE(testing::Message() << "target " << static_cast<int>(target));
                    expect_same(*scalar, *result_of(kernel, function, items, begin, flavour));
                }
            }
        }
    }
}

/// Buffer and number of a 32-bit word in it.
using Word = std::pair<std::size_t, std::size_t>;

std::set<Word> changed_words(const KernelCase& before, const KernelCase& after) {
    std::set<Word> words;
    for (std::size_t b = 0; b < before.buffers.size(); ++b) {
        const auto* x = static_cast<const std::uint32_t*>(before.buffers[b]->host());
        const auto* y = static_cast<const std::uint32_t*>(after.buffers[b]->host());
        for (std::size_t w = 0; w < before.buffers[b]->bytes() / sizeof(std::uint32_t); ++w) {
            if (x[w] != y[w]) words.emplace(b, w);
        }
    }
    return words;
}

/// What an item writes is known by running it alone. Items of one launch may run at once, so no two
/// write the same; and a range writes what its items write, whatever packs it is cut into.
TEST_P(EveryKernel, TouchesNothingButItsItems) {
    constexpr int kItems = 40;
    const kernels::KernelInfo& kernel = *GetParam();
    const auto made = [&] { return make_case(kernel.name, kItems, Flavour::kRandom, 40); };
    const auto run = [&](kernels::RangeFunction function, int begin, int end) {
        const auto after = made();
        run_on_host(after->launch, function, begin, end, kInstance);
        return changed_words(*made(), *after);
    };
    std::vector<std::set<Word>> of_item;
    std::set<Word> of_any;
    for (int i = 0; i < kItems; ++i) {
        of_item.push_back(run(kernel.scalar, i, i + 1));
        for (const Word& word : of_item.back()) {
            EXPECT_TRUE(of_any.insert(word).second) << "item " << i << " and one before it";
        }
    }
    EXPECT_FALSE(of_any.empty()) << "the case's data change nothing";
    for (const auto& [begin, end] :
         {std::pair{0, 1}, {0, 8}, {3, 16}, {11, 30}, {17, 17}, {5, 38}, {39, 40}}) {
        std::set<Word> expected;
        for (int i = begin; i < end; ++i)
            expected.merge(std::set(of_item[static_cast<std::size_t>(i)]));
        EXPECT_EQ(run(kernel.scalar, begin, end), expected) << "items " << begin << " to " << end;
        for (const auto& [target, function] : kernel.packed_forms) {
            EXPECT_EQ(run(function, begin, end), expected)
                << "items " << begin << " to " << end << ", target " << static_cast<int>(target);
        }
    }
}

std::string name_of_kernel(const testing::TestParamInfo<const kernels::KernelInfo*>& info) {
    return std::string(info.param->name);
}

INSTANTIATE_TEST_SUITE_P(Kernels, EveryKernel, testing::ValuesIn(kernels::all_kernels()),
                         name_of_kernel);

}  // namespace
}  // namespace weft::test
