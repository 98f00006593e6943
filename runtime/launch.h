#pragma once

#include <array>
#include <memory>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "runtime/buffer.h"

namespace weft {

/// Where a kernel's items lie: for each strip, one segment per colour. Strips are independent of
/// each other; the segments of one strip run in the order of their colours.
///
/// Segment first + strip * colour_count + colour holds the items [begin[segment], begin[segment +
/// 1]): the items of a strip are contiguous, and so are those of a range of strips. (With the
/// segments of one colour side by side instead, a strip's sweep would begin a new stream of memory
/// at every segment.)
struct Segments {
    const Buffer<int>* begin = nullptr;  ///< [first + strip_count * colour_count + 1], or more
    int first = 0;                       ///< where this table starts within `begin`
    int colour_count = 1;
    int strip_count = 0;

    /// The first item of a strip's colour; colour_count: where the strip ends.
    int item(int strip, int colour = 0) const {
        return (*begin)[static_cast<std::size_t>(first + strip * colour_count + colour)];
    }
    /// Items of all colours in strips [first_strip, end_strip).
    int item_count(int first_strip, int end_strip) const {
        return item(end_strip) - item(first_strip);
    }
    /// The most items of one colour in one of these strips.
    int largest(int colour, int first_strip, int end_strip) const;
};

/// Strips of about the same size over items 0 to item_count, in one colour.
/// begin  [strips + 1], filled in; it must outlive the table. Throws Misuse for fewer than 2.
Segments even_strips(Buffer<int>& begin, int item_count);

/// Stands for an int parameter that takes the number of the running instance of the step: within a
/// frame, the number of the substep.
struct Instance {};
inline constexpr Instance kInstance{};

/// Stands for an int parameter that takes the running task's iteration (Task::iteration).
struct Iteration {};
inline constexpr Iteration kIteration{};

/// What an int parameter is filled in with when its task runs.
enum class RunValue { kNone, kOfInstance, kOfIteration };

/// The value of one parameter of a kernel.
struct Argument {
    BufferStorage* buffer = nullptr;  ///< for pointer parameters
    RunValue run_value = RunValue::kNone;
    float real = 0.0f;
    int integer = 0;
};

/// One kernel with all its arguments, ready to run over the items of any range of strips.
struct Launch {
    const kernels::KernelInfo* kernel = nullptr;
    std::vector<Argument> arguments;
    Segments segments;
    /// Whether its buffers and its strip table are still there.
    std::vector<std::shared_ptr<const bool>> alive = {};
    /// [strips] Where it is given, strips of which it says 0 are passed over; see only_where().
    Buffer<int>* gate = nullptr;
};

/// The same launch, of strips alone of which `gate` does not say 0 when the task gets to it: what
/// kernels have found out before, in other tasks or by launches in front of this one. For work that
/// has to be done in few places, and not the same in every run of a step.
/// gate  [strips]; it must outlive the launch. The task reads it. Throws Misuse where it is shorter.
Launch only_where(Buffer<int>& gate, Launch launch);

/// Whether a launch with this gate, or none, passes over a strip; the gate is the host's.
inline bool is_closed(const Buffer<int>* gate, int strip) {
    return gate != nullptr && (*gate)[static_cast<std::size_t>(strip)] == 0;
}

/// Throws Misuse where the CPU has no form of the kernel with so many lanes.
void check_variant(const Launch& launch, int lanes);

/// Launches that run one after the other on each strip: what a task does. Tasks of one kind share
/// it.
struct TaskBody {
    std::string name;  ///< of the kind, for traces
    int kind = 0;      ///< what the cost model tells apart
    std::vector<Launch> launches;
    /// So many of the first launches take turns: all of them for colour 0, then all for colour 1,
    /// and so on. They have the same strips and numbers of colours.
    int taking_turns = 0;

    /// What the cost model counts: items of all launches in strips [first_strip, end_strip).
    long item_count(int first_strip, int end_strip) const;
};

/// Does all of a body's work on one strip, by the scalar kernels: for devices of one's own, and for
/// tests of others. Throws Misuse where a kernel has no scalar variant.
void run_on_host(const TaskBody& body, int strip, int instance = 0, int iteration = 0);

namespace detail {

/// Throws Misuse where nobody has compiled it.
const kernels::KernelInfo* compiled_kernel(const std::string& name);

template <class Parameter, class Value>
Argument make_argument(Value& value) {
    using V = std::remove_const_t<Value>;
    Argument argument;
    if constexpr (std::is_pointer_v<Parameter>) {
        using Element = std::remove_const_t<std::remove_pointer_t<Parameter>>;
        static_assert(std::is_same_v<V, Buffer<Element>>,
                      "this parameter takes a Buffer of its type");
        static_assert(!std::is_const_v<Value>,
                      "a launch takes buffers that are not const, also for what it only reads");
        argument.buffer = &value;
    } else if constexpr (std::is_same_v<V, Instance> || std::is_same_v<V, Iteration>) {
        static_assert(std::is_same_v<Parameter, int>, "instance and iteration are ints");
        argument.run_value =
            std::is_same_v<V, Instance> ? RunValue::kOfInstance : RunValue::kOfIteration;
    } else {
        static_assert(std::is_same_v<V, Parameter>, "float for float, int for int");
        if constexpr (std::is_same_v<Parameter, float>)
            argument.real = value;
        else
            argument.integer = value;
    }
    return argument;
}

template <class Parameters, class... Values, std::size_t... I>
std::vector<Argument> make_arguments(std::index_sequence<I...>, Values&... values) {
    return {make_argument<std::tuple_element_t<I, Parameters>>(values)...};
}

template <class Value>
constexpr bool is_temporary_buffer =
    !std::is_lvalue_reference_v<Value> && std::is_base_of_v<BufferStorage, std::decay_t<Value>>;

/// Of the strip table and of each argument that is a buffer.
std::vector<std::shared_ptr<const bool>> lives_of(const Segments& segments,
                                                  const std::vector<Argument>& arguments);

}  // namespace detail

/// Binds a kernel's arguments: launch(kernels::project_springs, segments, positions, ends, ...).
/// A missing argument, or a buffer of another type than the kernel's parameter, does not compile.
/// Throws Misuse for a kernel that was not compiled: weft_add_kernels() does that.
template <class Kernel, class... Values>
Launch launch(Kernel, const Segments& segments, Values&&... values) {
    using Parameters = kernels::ParametersOf<Kernel>;
    static_assert(std::tuple_size_v<Parameters> == sizeof...(Values),
                  "one argument per parameter of the kernel");
    static_assert((!detail::is_temporary_buffer<Values&&> && ...),
                  "a buffer must outlive what is launched on it: no temporaries");
    auto arguments =
        detail::make_arguments<Parameters>(std::index_sequence_for<Values...>(), values...);
    auto alive = detail::lives_of(segments, arguments);
    return {detail::compiled_kernel(kernels::name_of_kernel<Kernel>()), std::move(arguments),
            segments, std::move(alive)};
}

}  // namespace weft
