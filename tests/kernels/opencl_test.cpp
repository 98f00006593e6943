// OpenCL gives the bits of the scalar C++ kernels, with 1 and 8 lanes and in all styles of entry
// points.

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "kernels/registry.h"
#include "runtime/device_list.h"
#include "runtime/opencl/opencl_device.h"
#include "runtime/opencl/program.h"
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

class ProgramTexts : public testing::Test {
protected:
    ProgramTexts() {
        for (const auto& one : cases_) {
            bodies_.push_back({std::string(one->launch.kernel->name), 0, {one->launch}});
        }
        for (const TaskBody& body : bodies_) pointers_.push_back(&body);
    }

    ProgramText text(const EntryOptions& options) const { return program_text(pointers_, options); }

private:
    std::vector<std::unique_ptr<KernelCase>> cases_ = all_cases(Flavour::kRandom);
    std::vector<TaskBody> bodies_;
    std::vector<const TaskBody*> pointers_;
};

/// What NVIDIA's compiler refuses, and others take for an extension.
TEST_F(ProgramTexts, DefineNoMacroOfAnyNumberOfArguments) {
    std::istringstream lines(text({}).text);
    int definitions = 0;
    for (std::string line; std::getline(lines, line);) {
        const bool is_definition = line.starts_with("#define");
        definitions += is_definition ? 1 : 0;
        EXPECT_FALSE(is_definition && line.find("...") != std::string::npos) << line;
        EXPECT_FALSE(line.starts_with("WEFT_KERNEL(")) << line;
    }
    EXPECT_GT(definitions, 10);
}

TEST_F(ProgramTexts, HaveNoGroupsForMoreParametersThanThereMayBe) {
    const std::size_t some = 120;
    const auto count = [&](std::size_t most) {
        const ProgramText made = text({EntryStyle::kPerGroup, 16, most});
        return std::ranges::count(made.entries, EntryStyle::kPerGroup, &BodyEntries::style);
    };
    EXPECT_EQ(count(0), 0);
    EXPECT_GT(count(some), 0);
    EXPECT_LT(count(some), count(1 << 20));
    EXPECT_EQ(count(1 << 20), std::ssize(text({}).entries));
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
