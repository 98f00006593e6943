// All forms of one kernel give the same bits: scalar, packed for the baseline, packed for this
// processor.

#include <gtest/gtest.h>

#include "kernels/registry.h"
#include "tests/kernels/baseline_kernels.h"
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
    ASSERT_NE(kernel.packed, nullptr);
    ASSERT_NE(baseline_packed(kernel.name), nullptr);
    for (const Flavour flavour : {Flavour::kRandom, Flavour::kDegenerate}) {
        for (const int items : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 150}) {
            for (const int begin : {0, items / 3}) {
                SCOPED_TRACE(testing::Message() << "items " << begin << " to " << items);
                const auto scalar = result_of(kernel, kernel.scalar, items, begin, flavour);
                expect_finite(*scalar);
                expect_same(*scalar, *result_of(kernel, kernel.packed, items, begin, flavour));
                expect_same(*scalar, *result_of(kernel, baseline_packed(kernel.name), items, begin,
                                                flavour));
            }
        }
    }
}

TEST_P(EveryKernel, TouchesNothingButItsItems) {
    const kernels::KernelInfo& kernel = *GetParam();
    for (const auto function : {kernel.scalar, kernel.packed}) {
        const auto untouched = make_case(kernel.name, 40, Flavour::kRandom, 40);
        auto made = make_case(kernel.name, 40, Flavour::kRandom, 40);
        run_on_host(made->launch, function, 17, 17, kInstance);
        expect_same(*untouched, *made);
    }
}

std::string name_of_kernel(const testing::TestParamInfo<const kernels::KernelInfo*>& info) {
    return std::string(info.param->name);
}

INSTANTIATE_TEST_SUITE_P(Kernels, EveryKernel, testing::ValuesIn(kernels::all_kernels()),
                         name_of_kernel);

}  // namespace
}  // namespace weft::test
