// OpenCL gives the bits of the scalar C++ kernels, with 1 and 8 lanes and in both entry styles.

#include <gtest/gtest.h>

#include "kernels/registry.h"
#include "runtime/device_list.h"
#include "runtime/opencl/opencl_device.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

struct Style {
    int lanes;
    bool per_colour;
};

using Parameters = std::tuple<const kernels::KernelInfo*, Style>;

class OpenClKernel : public testing::TestWithParam<Parameters> {
protected:
    void SetUp() override {
        if (opencl_devices().empty()) GTEST_SKIP() << "no OpenCL device here";
    }
};

TEST_P(OpenClKernel, HasTheBitsOfTheScalarKernel) {
    const auto& [kernel, style] = GetParam();
    DeviceOptions options;
    options.opencl_lanes = style.lanes;
    options.per_colour = style.per_colour;
    // Interpreters such as oclgrind say that they share the host's memory, but work on copies.
    options.memory = MemoryModel::kDiscrete;
    const auto devices = open_devices("opencl:0", options);
    for (const Flavour flavour : {Flavour::kRandom, Flavour::kDegenerate}) {
        const auto expected = make_case(kernel->name, 151, flavour, 7);
        run_on_host(expected->launch, kernel->scalar, 0, expected->items, 2);
        auto actual = make_case(kernel->name, 151, flavour, 7);
        run_on_device(*actual, *devices.front(), 2);
        expect_same(*expected, *actual);
    }
}

std::string name_of(const testing::TestParamInfo<Parameters>& info) {
    const auto& [kernel, style] = info.param;
    return std::string(kernel->name) + (style.per_colour ? "_per_colour_" : "_per_strip_") +
           std::to_string(style.lanes);
}

INSTANTIATE_TEST_SUITE_P(OneLane, OpenClKernel,
                         testing::Combine(testing::ValuesIn(kernels::all_kernels()),
                                          testing::Values(Style{1, true}, Style{1, false})),
                         name_of);
INSTANTIATE_TEST_SUITE_P(EightLanes, OpenClKernel,
                         testing::Combine(testing::ValuesIn(kernels::all_kernels()),
                                          testing::Values(Style{8, true}, Style{8, false})),
                         name_of);

}  // namespace
}  // namespace weft::test
