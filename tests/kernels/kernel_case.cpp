#include "tests/kernels/kernel_case.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <numeric>

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

/// A parameter's value or the address of its buffer, where a range function looks for it.
union Slot {
    float real;
    int integer;
    void* pointer;
};

void expect_finite(const BufferStorage& buffer) {
    if (dynamic_cast<const Buffer<int>*>(&buffer) != nullptr) return;
    const auto* values = static_cast<const float*>(buffer.host());
    for (std::size_t i = 0; i < buffer.bytes() / sizeof(float); ++i) {
        ASSERT_TRUE(std::isfinite(values[i])) << buffer.name() << ", float " << i;
    }
}

}  // namespace

std::vector<int> Random::permutation(int count) {
    std::vector<int> list(static_cast<std::size_t>(count));
    std::iota(list.begin(), list.end(), 0);
    for (std::size_t i = list.size(); i > 1; --i) std::swap(list[i - 1], list[engine_() % i]);
    return list;
}

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

bool add_case(std::string_view kernel, MakeCase make) { return makers().emplace(kernel, make).second; }

std::unique_ptr<KernelCase> make_case(std::string_view kernel, int items, Flavour flavour,
                                      unsigned seed) {
    const auto maker = makers().find(kernel);
    if (maker == makers().end()) return make_obstacle_case(kernel, items, flavour, seed);
    auto made = std::make_unique<KernelCase>(items, flavour, seed);
    maker->second(*made);
    return made;
}

void run_on_host(const Launch& launch, kernels::RangeFunction function, int begin, int end,
                 int instance) {
    std::vector<Slot> values(launch.arguments.size());
    std::vector<const void*> addresses;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Argument& argument = launch.arguments[i];
        if (argument.buffer != nullptr) values[i].pointer = argument.buffer->host();
        else if (launch.kernel->parameters[i] == kernels::Parameter::kFloat) values[i].real = argument.real;
        else values[i].integer = argument.is_instance ? instance : argument.integer;
        addresses.push_back(&values[i]);
    }
    function(begin, end, addresses.data());
}

void run_on_device(KernelCase& kernel_case, Device& device, int instance) {
    const TaskBody body{"kernel", 0, {kernel_case.launch}};
    Step step;
    auto task = step.add(body, 0, 0, kernel_case.segments.strip_count, 0);
    for (const auto& buffer : kernel_case.buffers) {
        task.updates(*buffer, 0, static_cast<int>(buffer->count()));
    }
    step.seal();
    scheduler::Plan plan;
    plan.placements = {{0.0, 1.0, 0}};

    const TaskBody* const bodies[] = {&body};
    Executor executor({&device}, bodies);
    executor.run(step, plan, 1, instance);
    for (const auto& buffer : kernel_case.buffers) executor.fetch(*buffer);
}

std::vector<std::vector<std::byte>> contents(const KernelCase& kernel_case) {
    std::vector<std::vector<std::byte>> all;
    for (const auto& buffer : kernel_case.buffers) {
        const auto* bytes = static_cast<const std::byte*>(buffer->host());
        all.emplace_back(bytes, bytes + buffer->bytes());
    }
    return all;
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
    for (const auto& buffer : kernel_case.buffers) expect_finite(*buffer);
}

}  // namespace weft::test
