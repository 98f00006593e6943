#include "tests/kernels/run_on_host.h"

namespace weft::test {

namespace {

/// A parameter's value or the address of its buffer, where a range function looks for it.
union Slot {
    float real;
    int integer;
    void* pointer;
};

}  // namespace

void run_on_host(const Launch& launch, kernels::RangeFunction function, int begin, int end,
                 int instance, int iteration) {
    std::vector<Slot> values(launch.arguments.size());
    std::vector<const void*> addresses;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Argument& argument = launch.arguments[i];
        if (argument.buffer != nullptr)
            values[i].pointer = argument.buffer->host();
        else if (launch.kernel->parameters[i] == kernels::Parameter::kFloat)
            values[i].real = argument.real;
        else
            values[i].integer = argument.run_value == RunValue::kOfInstance    ? instance
                                : argument.run_value == RunValue::kOfIteration ? iteration
                                                                               : argument.integer;
        addresses.push_back(&values[i]);
    }
    function(begin, end, addresses.data());
}

}  // namespace weft::test
