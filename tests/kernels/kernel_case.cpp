#include "tests/kernels/kernel_case.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>

#include "runtime/executor.h"

namespace weft::test {

namespace {

constexpr int kStrips = 9;
constexpr int kColours = 3;
constexpr int kFirst = 2;  // segment tables share a buffer with others

std::map<std::string_view, MakeCase>& makers() {
    static std::map<std::string_view, MakeCase> instance;
    return instance;
}

void expect_finite(const BufferStorage& buffer) {
    const auto* values = static_cast<const float*>(buffer.host());
    for (std::size_t i = 0; i < buffer.bytes() / sizeof(float); ++i) {
        ASSERT_TRUE(std::isfinite(values[i])) << buffer.name() << ", float " << i;
    }
}

}  // namespace

KernelCase::KernelCase(int item_count, Flavour kind, unsigned seed)
    : items(item_count),
      flavour(kind),
      random(seed),
      segment_begin("segments", kFirst + kStrips * kColours + 1),
      segments{&segment_begin, kFirst, kColours, kStrips} {
    int next = 0;
    for (int i = kFirst; i < kFirst + kStrips * kColours; ++i) {
        segment_begin[static_cast<std::size_t>(i)] = next;
        next = std::min(items, next + random.integer(0, 19));
    }
    segment_begin[kFirst + kStrips * kColours] = items;
}

bool add_case(std::string_view kernel, MakeCase make) {
    return makers().emplace(kernel, make).second;
}

std::unique_ptr<KernelCase> make_case(std::string_view kernel, int items, Flavour flavour,
                                      unsigned seed) {
    const auto maker = makers().find(kernel);
    if (maker == makers().end()) return make_obstacle_case(kernel, items, flavour, seed);
    auto made = std::make_unique<KernelCase>(items, flavour, seed);
    maker->second(*made);
    return made;
}

namespace {

/// Several launches in a task build faster than as many tasks, and this many arguments still fit
/// into the least that OpenCL grants an entry point (CL_DEVICE_MAX_PARAMETER_SIZE, 1024 bytes).
constexpr std::size_t kMostArguments = 80;

std::size_t arguments_of(const Launch& launch) {
    constexpr std::size_t kOfSegments = 3;
    return launch.arguments.size() + kOfSegments;
}

/// Where each task's cases begin, and the end.
std::vector<std::size_t> group(std::span<const std::unique_ptr<KernelCase>> cases) {
    std::vector<std::size_t> starts{0};
    std::size_t arguments = 0;
    for (std::size_t c = 0; c < cases.size(); ++c) {
        const std::size_t own = arguments_of(cases[c]->launch);
        if (arguments + own > kMostArguments && c > starts.back()) {
            starts.push_back(c);
            arguments = 0;
        }
        arguments += own;
    }
    starts.push_back(cases.size());
    return starts;
}

}  // namespace

void run_on_device(std::span<const std::unique_ptr<KernelCase>> cases, Device& device,
                   int instance) {
    const std::vector<std::size_t> starts = group(cases);
    std::vector<TaskBody> bodies(starts.size() - 1);
    std::vector<const TaskBody*> pointers;
    Step step;
    scheduler::Plan plan;
    for (std::size_t t = 0; t < bodies.size(); ++t) {
        const auto own = cases.subspan(starts[t], starts[t + 1] - starts[t]);
        bodies[t].name = std::string(own.front()->launch.kernel->name);
        for (const auto& one : own) bodies[t].launches.push_back(one->launch);
        pointers.push_back(&bodies[t]);
        auto task = step.add(bodies[t], 0, {0, kStrips});
        for (const auto& one : own) {
            for (const auto& buffer : one->buffers) {
                task.updates(*buffer, 0, static_cast<int>(buffer->count()));
            }
        }
        plan.placements.push_back({static_cast<double>(t), static_cast<double>(t + 1), 0});
    }
    step.seal();
    plan.order_by_start(1);

    Executor executor({&device}, pointers);
    executor.run(step, plan, 1, instance);
    for (const auto& one : cases) {
        for (const auto& buffer : one->buffers) executor.fetch(*buffer);
    }
}

void expect_same(const KernelCase& expected, const KernelCase& actual) {
    ASSERT_EQ(expected.buffers.size(), actual.buffers.size());
    for (std::size_t b = 0; b < expected.buffers.size(); ++b) {
        const BufferStorage& one = *expected.buffers[b];
        const BufferStorage& other = *actual.buffers[b];
        ASSERT_EQ(one.bytes(), other.bytes());
        const auto* x = static_cast<const float*>(one.host());
        const auto* y = static_cast<const float*>(other.host());
        for (std::size_t i = 0; i < one.bytes() / sizeof(float); ++i) {
            ASSERT_EQ(std::memcmp(x + i, y + i, sizeof(float)), 0)
                << one.name() << ", float " << i << ": " << x[i] << " and " << y[i];
        }
    }
}

void expect_finite(const KernelCase& kernel_case) {
    for (std::size_t b = 0; b < kernel_case.buffers.size(); ++b) {
        if (kernel_case.has_reals[b]) expect_finite(*kernel_case.buffers[b]);
    }
}

}  // namespace weft::test
