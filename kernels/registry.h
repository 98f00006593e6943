#pragma once

#include <cstddef>
#include <map>
#include <string>
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
    kInt,
    kReadOther,  ///< of an element type of one's own
    kWriteOther
};

/// A namespace of kernels, as a type: what WEFT_KERNELS_IN can say several times.
template <std::size_t N>
struct FixedText {
    char text[N] = {};
    constexpr FixedText(const char (&from)[N]) {
        for (std::size_t i = 0; i < N; ++i) text[i] = from[i];
    }
};
template <FixedText T>
struct KernelSpace {
    static constexpr const char* kName = T.text;
};
using kernel_space = KernelSpace<"">;  ///< of Weft's own kernels

/// Runs one kernel over items [begin, end). `arguments` points to one value per parameter.
using RangeFunction = void (*)(int begin, int end, const void* const* arguments);

/// What kernels are compiled for. kPacked has 8 lanes and is built for the baseline of the
/// architecture; for x86-64 there are kPackedAvx2, of 8 lanes, too, and kPackedAvx512, of 16 (F,
/// VL, DQ and BW, as all processors since Skylake's servers have them together).
enum class Target { kScalar, kPacked, kPackedAvx2, kPackedAvx512 };

/// All that is known of one kernel.
struct KernelInfo {
    std::string_view name;   ///< without its namespace
    std::string_view space;  ///< "heat::"; empty: Weft's own
    std::string_view file;   ///< the header that defines it, as its compiler names it
    std::vector<Parameter> parameters;
    std::string_view parameter_text;  ///< as they are written
    RangeFunction scalar = nullptr;   ///< one item at a time
    /// Those with lanes that this processor can run.
    std::map<Target, RangeFunction> packed_forms = {};

    /// The best for packs of so many lanes at the most; null where there is none.
    RangeFunction form(int lanes) const;
};

/// Lanes of the widest packs that this processor has instructions for: 8 or 16.
int widest_pack();

/// The kernel of that name, with its namespace: "heat::diffuse". Every kernel is registered before
/// main() begins. Throws std::logic_error where nobody has compiled it.
const KernelInfo& kernel_info(const std::string& name);

/// All kernels, ordered by name.
std::vector<const KernelInfo*> all_kernels();

// ---- registration, by WEFT_KERNEL ----

/// The names live as long as the program. name: with its namespace.
bool add_kernel(const std::string& name, KernelInfo info);
bool add_range_function(Target target, const std::string& name, RangeFunction function);

template <class T>
inline constexpr bool is_other_element =
    std::is_pointer_v<T>&& std::is_class_v<std::remove_pointer_t<T>> &&
    !std::is_same_v<std::remove_cv_t<std::remove_pointer_t<T>>, float4>;

template <class T>
constexpr Parameter parameter_of() {
    static_assert(is_other_element<T> || std::is_same_v<T, float> || std::is_same_v<T, int> ||
                      (std::is_pointer_v<T> && (std::is_convertible_v<T, const float*> ||
                                                std::is_convertible_v<T, const int*> ||
                                                std::is_convertible_v<T, const float4*>)),
                  "a kernel's parameters are float, int, or pointers to float, int, float4 or a "
                  "struct of one's own");
    if constexpr (std::is_same_v<T, const float*>) return Parameter::kReadFloat;
    if constexpr (std::is_same_v<T, const int*>) return Parameter::kReadInt;
    if constexpr (std::is_same_v<T, const float4*>) return Parameter::kReadFloat4;
    if constexpr (std::is_same_v<T, float*>) return Parameter::kWriteFloat;
    if constexpr (std::is_same_v<T, int*>) return Parameter::kWriteInt;
    if constexpr (std::is_same_v<T, float4*>) return Parameter::kWriteFloat4;
    if constexpr (std::is_same_v<T, float>) return Parameter::kFloat;
    if constexpr (std::is_same_v<T, int>) return Parameter::kInt;
    if constexpr (is_other_element<T>) {
        return std::is_const_v<std::remove_pointer_t<T>> ? Parameter::kReadOther
                                                         : Parameter::kWriteOther;
    }
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

/// With its namespace.
template <class Kernel>
std::string name_of_kernel() {
    return std::string(Kernel::kSpace) + Kernel::kName;
}

template <class Kernel>
bool register_scalar() {
    return add_kernel(name_of_kernel<Kernel>(),
                      {.name = Kernel::kName,
                       .space = Kernel::kSpace,
                       .file = Kernel::kFile,
                       .parameters = Signature<decltype(Kernel::run)>::parameters(),
                       .parameter_text = Kernel::kParameters}) &&
           add_range_function(Target::kScalar, name_of_kernel<Kernel>(), &run_range<Kernel>);
}

template <class Kernel>
bool register_packed(Target target) {
    return add_range_function(target, name_of_kernel<Kernel>(), &run_range<Kernel>);
}

}  // namespace weft::kernels
