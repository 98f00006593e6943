// OpenCL gives the bits of the scalar C++ kernels, with 1 and 8 lanes and in all styles of entry
// points.

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "kernels/registry.h"
#include "runtime/device_list.h"
#include "runtime/opencl/entry_points.h"
#include "runtime/opencl/opencl_device.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

constexpr int kItems = 151;
constexpr int kSubstep = 2;

struct Style {
    int lanes;
    EntryStyle entries;
};

class OpenClKernels : public testing::TestWithParam<Style> {
protected:
    void SetUp() override {
        if (opencl_devices().empty()) GTEST_SKIP() << "no OpenCL device here";
    }
};

std::vector<std::unique_ptr<KernelCase>> all_cases(Flavour flavour) {
    std::vector<std::unique_ptr<KernelCase>> cases;
    for (const kernels::KernelInfo* kernel : kernels::all_kernels()) {
        if (auto made = make_case(kernel->name, kItems, flavour, 7))
            cases.push_back(std::move(made));
    }
    return cases;
}

class EntryTexts : public testing::Test {
protected:
    EntryTexts() {
        for (const auto& one : cases_) {
            bodies_.push_back({std::string(one->launch.kernel->name), 0, {one->launch}});
        }
    }

    std::vector<EntryPoints> made(const EntryOptions& options) const {
        std::vector<EntryPoints> all;
        for (const TaskBody& body : bodies_) all.push_back(entry_points(body, options));
        return all;
    }

private:
    std::vector<std::unique_ptr<KernelCase>> cases_ = all_cases(Flavour::kRandom);
    std::vector<TaskBody> bodies_;
};

/// What NVIDIA's compiler refuses, and others take for an extension.
TEST_F(EntryTexts, DefineNoMacroOfAnyNumberOfArguments) {
    for (const EntryPoints& points : made({})) {
        std::istringstream lines(program_text(points));
        int definitions = 0;
        for (std::string line; std::getline(lines, line);) {
            const bool is_definition = line.starts_with("#define");
            definitions += is_definition ? 1 : 0;
            EXPECT_FALSE(is_definition && line.find("...") != std::string::npos) << line;
            EXPECT_FALSE(line.starts_with("WEFT_KERNEL(")) << line;
        }
        EXPECT_GT(definitions, 10);
    }
}

TEST_F(EntryTexts, HaveNoGroupsForMoreParametersThanThereMayBe) {
    const std::size_t some = 120;
    const auto count = [&](std::size_t most) {
        const auto all = made({EntryStyle::kPerGroup, 16, most});
        return std::ranges::count(all, EntryStyle::kPerGroup, &EntryPoints::style);
    };
    EXPECT_EQ(count(0), 0);
    EXPECT_GT(count(some), 0);
    EXPECT_LT(count(some), count(1 << 20));
    EXPECT_EQ(count(1 << 20), std::ssize(made({})));
}

TEST_P(OpenClKernels, HaveTheBitsOfTheScalarOnes) {
    DeviceOptions options;
    options.opencl_lanes = GetParam().lanes;
    options.entry_style = GetParam().entries;
    options.group_size = 16;
    const auto devices = open_devices("opencl:0", options);
    for (const Flavour flavour : {Flavour::kRandom, Flavour::kDegenerate}) {
        const auto actual = all_cases(flavour);
        run_on_device(actual, *devices.front(), kSubstep);
        const auto expected = all_cases(flavour);
        for (std::size_t c = 0; c < expected.size(); ++c) {
            SCOPED_TRACE(expected[c]->launch.kernel->name);
            const Launch& launch = expected[c]->launch;
            run_on_host(launch, launch.kernel->scalar, 0, kItems, kSubstep);
            expect_same(*expected[c], *actual[c]);
        }
    }
}

std::string name_of_style(const testing::TestParamInfo<Style>& info) {
    switch (info.param.entries) {
        case EntryStyle::kPerStrip:
            return "PerStrip";
        case EntryStyle::kPerGroup:
            return "PerGroup";
        case EntryStyle::kPerColour:
            return "PerColour";
    }
    return {};
}

INSTANTIATE_TEST_SUITE_P(OneLane, OpenClKernels,
                         testing::Values(Style{1, EntryStyle::kPerStrip},
                                         Style{1, EntryStyle::kPerGroup},
                                         Style{1, EntryStyle::kPerColour}),
                         name_of_style);
INSTANTIATE_TEST_SUITE_P(EightLanes, OpenClKernels,
                         testing::Values(Style{8, EntryStyle::kPerStrip},
                                         Style{8, EntryStyle::kPerColour}),
                         name_of_style);

}  // namespace
}  // namespace weft::test
