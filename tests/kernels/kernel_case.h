#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/device.h"
#include "runtime/launch.h"

namespace weft::test {

/// Random numbers that are the same with every standard library.
class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}

    float real(float low, float high) {
        return low + (high - low) * static_cast<float>(engine_() >> 8) / static_cast<float>(1U << 24);
    }
    /// In [low, high].
    int integer(int low, int high) {
        return low + static_cast<int>(engine_() % static_cast<unsigned>(high - low + 1));
    }
    float4 point(float size) {
        return {real(-size, size), real(-size, size), real(-size, size), 0.0f};
    }
    /// 0 .. count - 1 in random order.
    std::vector<int> permutation(int count);

private:
    std::mt19937 engine_;
};

enum class Flavour {
    kRandom,
    kDegenerate,  ///< zero lengths, held vertices, points on centres, edges and surfaces
};

/// One launch of a kernel over independent items, with data of its own. The same seed makes the same
/// data.
struct KernelCase {
    KernelCase(int items, Flavour flavour, unsigned seed);

    template <class T>
    Buffer<T>& add(const std::string& name, int count) {
        auto buffer = std::make_unique<Buffer<T>>(name, static_cast<std::size_t>(count));
        Buffer<T>& reference = *buffer;
        buffers.push_back(std::move(buffer));
        return reference;
    }

    int items;
    Flavour flavour;
    Random random;
    std::vector<std::unique_ptr<BufferStorage>> buffers;
    Buffer<int> segment_begin;
    Segments segments;  ///< the items in strips and colours of many sizes, some empty
    Launch launch;
};

using MakeCase = void (*)(KernelCase&);

/// Every *_cases.cpp of this folder adds the kernels of one family.
bool add_case(std::string_view kernel, MakeCase make);

/// A case of that kernel, or null where nobody added one.
std::unique_ptr<KernelCase> make_case(std::string_view kernel, int items, Flavour flavour,
                                      unsigned seed);

/// The same for the kernels of an obstacle's shape, which all have one signature.
std::unique_ptr<KernelCase> make_obstacle_case(std::string_view kernel, int items, Flavour flavour,
                                               unsigned seed);

/// Runs items [begin, end) of a launch by one of the kernel's compiled forms.
void run_on_host(const Launch& launch, kernels::RangeFunction function, int begin, int end,
                 int instance = 0);

/// Runs all items on a device, as a task of its own.
void run_on_device(KernelCase& kernel_case, Device& device, int instance = 0);

/// The bytes of all buffers.
std::vector<std::vector<std::byte>> contents(const KernelCase& kernel_case);

/// Expects the same bits in all buffers.
void expect_same(const KernelCase& expected, const KernelCase& actual);
void expect_finite(const KernelCase& kernel_case);

}  // namespace weft::test
