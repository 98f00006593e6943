#include "runtime/launch.h"

#include <algorithm>

#include "runtime/error.h"
#include "scheduler/assert.h"

namespace weft {

const kernels::KernelInfo* detail::compiled_kernel(const std::string& name) {
    try {
        return &kernels::kernel_info(name);
    } catch (const std::logic_error& error) {
        throw Misuse(error.what());
    }
}

std::vector<std::shared_ptr<const bool>> detail::lives_of(const Segments& segments,
                                                          const std::vector<Argument>& arguments) {
    std::vector<std::shared_ptr<const bool>> lives;
    if (segments.begin != nullptr) lives.push_back(segments.begin->alive());
    for (const Argument& argument : arguments) {
        if (argument.buffer != nullptr) lives.push_back(argument.buffer->alive());
    }
    return lives;
}

Launch only_where(Buffer<int>& gate, Launch launch) {
    const auto strips = static_cast<std::size_t>(launch.segments.strip_count);
    if (gate.count() < strips) {
        throw Misuse("buffer '" + gate.name() + "' says where kernel '" +
                     std::string(launch.kernel->name) + "' has something to do, and has " +
                     std::to_string(gate.count()) + " values for " + std::to_string(strips) +
                     " strips");
    }
    launch.gate = &gate;
    launch.alive.push_back(gate.alive());
    return launch;
}

void check_variant(const Launch& launch, int lanes) {
    const kernels::KernelInfo& kernel = *launch.kernel;
    if (kernel.form(lanes) != nullptr) return;
    throw Misuse("kernel '" + std::string(kernel.space) + std::string(kernel.name) + "' has no " +
                 (lanes == 1 ? "scalar" : "packed") +
                 " variant: give its header to weft_add_kernels()");
}

Segments even_strips(Buffer<int>& begin, int item_count) {
    const auto strips = static_cast<long>(begin.count()) - 1;
    if (strips < 1 || item_count < 0) {
        throw Misuse("buffer '" + begin.name() + "': " + std::to_string(begin.count()) +
                     " values say where strips of " + std::to_string(item_count) +
                     " items begin and the last one ends; that takes 2 at least");
    }
    for (long s = 0; s <= strips; ++s) {
        begin[static_cast<std::size_t>(s)] = static_cast<int>(item_count * s / strips);
    }
    return {&begin, 0, 1, static_cast<int>(strips)};
}

namespace {

/// A launch's values as a range function wants them.
class HostArguments {
public:
    HostArguments(const Launch& launch, int instance, int iteration) : values_(launch.arguments) {
        pointers_.reserve(values_.size());
        for (std::size_t i = 0; i < values_.size(); ++i) {
            Argument& value = values_[i];
            if (value.run_value == RunValue::kOfInstance) value.integer = instance;
            if (value.run_value == RunValue::kOfIteration) value.integer = iteration;
            if (value.buffer != nullptr) {
                addresses_.push_back(&pointers_.emplace_back(value.buffer->host()));
            } else if (launch.kernel->parameters[i] == kernels::Parameter::kFloat) {
                addresses_.push_back(&value.real);
            } else {
                addresses_.push_back(&value.integer);
            }
        }
    }
    const void* const* data() const { return addresses_.data(); }

private:
    std::vector<Argument> values_;
    std::vector<void*> pointers_;  // never grows: the addresses point into it
    std::vector<const void*> addresses_;
};

void run_on_host(const Launch& launch, int strip, int colour, int instance, int iteration) {
    check_variant(launch, 1);
    if (is_closed(launch.gate, strip)) return;
    const HostArguments arguments(launch, instance, iteration);
    const int begin = launch.segments.item(strip, colour);
    const int end = launch.segments.item(strip, colour + 1);
    if (begin < end) launch.kernel->scalar(begin, end, arguments.data());
}

}  // namespace

void run_on_host(const TaskBody& body, int strip, int instance, int iteration) {
    const auto turns = static_cast<std::size_t>(body.taking_turns);
    const int turn_colours = turns == 0 ? 0 : body.launches[0].segments.colour_count;
    for (int colour = 0; colour < turn_colours; ++colour) {
        for (std::size_t l = 0; l < turns; ++l) {
            run_on_host(body.launches[l], strip, colour, instance, iteration);
        }
    }
    for (std::size_t l = turns; l < body.launches.size(); ++l) {
        for (int colour = 0; colour < body.launches[l].segments.colour_count; ++colour) {
            run_on_host(body.launches[l], strip, colour, instance, iteration);
        }
    }
}

int Segments::largest(int colour, int first_strip, int end_strip) const {
    WEFT_ASSERT(0 <= colour && colour < colour_count);
    WEFT_ASSERT(0 <= first_strip && first_strip <= end_strip && end_strip <= strip_count);
    int most = 0;
    for (int strip = first_strip; strip < end_strip; ++strip) {
        WEFT_ASSERT(item(strip, colour) <= item(strip, colour + 1));
        most = std::max(most, item(strip, colour + 1) - item(strip, colour));
    }
    return most;
}

long TaskBody::item_count(int first_strip, int end_strip) const {
    long count = 0;
    for (const Launch& launch : launches) {
        WEFT_ASSERT(end_strip <= launch.segments.strip_count);
        count += launch.segments.item_count(first_strip, end_strip);
    }
    WEFT_ASSERT(count >= 0);
    return count;
}

}  // namespace weft
