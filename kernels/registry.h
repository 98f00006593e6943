#pragma once

#include <cstddef>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

/// How the runtime finds a kernel's compiled forms. C++ only; a kernel's author need not look here.
namespace weft {
struct float4;
}

namespace weft::kernels {

/// Types that a kernel's parameters may have.
enum class Parameter {
    kReadFloat,
    kReadInt,
    kReadFloat4,
    kWriteFloat,
    kWriteInt,
    kWriteFloat4,
    kFloat,
    kInt
};

/// Runs one kernel over items [begin, end). `arguments` points to one value per parameter.
using RangeFunction = void (*)(int begin, int end, const void* const* arguments);

/// All that is known of one kernel.
struct KernelInfo {
    std::string_view name;
    std::string_view file;  ///< the header that defines it, from the project's root
    std::vector<Parameter> parameters;
    RangeFunction scalar = nullptr;  ///< one item at a time
    RangeFunction packed = nullptr;  ///< 8 lanes, on the best instructions that this processor has
};

/// The kernel of that name. Every kernel is registered before main() begins.
const KernelInfo& kernel_info(std::string_view name);

/// All kernels, ordered by name.
std::vector<const KernelInfo*> all_kernels();

// ---- registration, by WEFT_KERNEL ----

/// kPacked is built for the baseline of the architecture, kPackedAvx2 (x86-64) for AVX2.
enum class Target { kScalar, kPacked, kPackedAvx2 };

bool add_kernel(std::string_view name, std::string_view file, std::vector<Parameter> parameters);
bool add_range_function(Target target, std::string_view name, RangeFunction function);

template <class T>
constexpr Parameter parameter_of() {
    if constexpr (std::is_same_v<T, const float*>) return Parameter::kReadFloat;
    if constexpr (std::is_same_v<T, const int*>) return Parameter::kReadInt;
    if constexpr (std::is_same_v<T, const float4*>) return Parameter::kReadFloat4;
    if constexpr (std::is_same_v<T, float*>) return Parameter::kWriteFloat;
    if constexpr (std::is_same_v<T, int*>) return Parameter::kWriteInt;
    if constexpr (std::is_same_v<T, float4*>) return Parameter::kWriteFloat4;
    if constexpr (std::is_same_v<T, float>) return Parameter::kFloat;
    if constexpr (std::is_same_v<T, int>) return Parameter::kInt;
}

template <class Function>
struct Signature;

template <class Item, class... Parameters>
struct Signature<void(Item, Parameters...)> {
    using Types = std::tuple<Parameters...>;

    static std::vector<Parameter> parameters() { return {parameter_of<Parameters>()...}; }
};

/// The types of a kernel's parameters, without the item.
template <class Kernel>
using ParametersOf = typename Signature<decltype(Kernel::run)>::Types;

template <class Kernel, class... Parameters, std::size_t... I>
void run_range(int begin, int end, const void* const* arguments, std::tuple<Parameters...>*,
               std::index_sequence<I...>) {
    // Copies, so that a store to a buffer cannot seem to change them.
    const std::tuple<Parameters...> values{*static_cast<const Parameters*>(arguments[I])...};
    constexpr int kLanes = Kernel::kLaneCount;
    for (; begin + kLanes <= end; begin += kLanes) {
        Kernel::run(typename Kernel::Item{begin, kLanes}, std::get<I>(values)...);
    }
    if (begin < end) Kernel::run(typename Kernel::Item{begin, end - begin}, std::get<I>(values)...);
}

template <class Kernel>
void run_range(int begin, int end, const void* const* arguments) {
    using Types = ParametersOf<Kernel>;
    run_range<Kernel>(begin, end, arguments, static_cast<Types*>(nullptr),
                      std::make_index_sequence<std::tuple_size_v<Types>>());
}

template <class Kernel>
bool register_scalar() {
    return add_kernel(Kernel::kName, Kernel::kFile,
                      Signature<decltype(Kernel::run)>::parameters()) &&
           add_range_function(Target::kScalar, Kernel::kName, &run_range<Kernel>);
}

template <class Kernel>
bool register_packed(Target target) {
    return add_range_function(target, Kernel::kName, &run_range<Kernel>);
}

}  // namespace weft::kernels
