#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "runtime/device.h"
#include "tests/kernels/random.h"
#include "tests/kernels/run_on_host.h"

namespace weft::test {

enum class Flavour {
    kRandom,
    kDegenerate,  ///< zero lengths, held vertices, points on centres, edges and surfaces
};

/// One launch of a kernel over independent items, with data of its own. The same seed makes the
/// same data.
struct KernelCase {
    KernelCase(int items, Flavour flavour, unsigned seed);

    template <class T>
    Buffer<T>& add(const std::string& name, int count) {
        auto buffer = std::make_shared<Buffer<T>>(name, static_cast<std::size_t>(count));
        Buffer<T>& reference = *buffer;
        buffers.push_back(std::move(buffer));
        has_reals.push_back(!std::is_same_v<T, int>);
        return reference;
    }
    /// The one that was added as number `index`, as the type that it has.
    template <class T>
    Buffer<T>& buffer(std::size_t index) {
        return static_cast<Buffer<T>&>(*buffers[index]);
    }

    int items;
    Flavour flavour;
    Random random;
    std::vector<std::shared_ptr<BufferStorage>> buffers;
    std::vector<bool> has_reals;  ///< [buffers]
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

/// Runs all items of all cases on a device, several cases to a task.
void run_on_device(std::span<const std::unique_ptr<KernelCase>> cases, Device& device,
                   int instance = 0);

/// Expects the same bits in all buffers.
void expect_same(const KernelCase& expected, const KernelCase& actual);
void expect_finite(const KernelCase& kernel_case);

}  // namespace weft::test
