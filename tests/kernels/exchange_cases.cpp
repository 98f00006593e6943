#include "kernels/exchange.h"

#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

struct States {
    Buffer<float4>& own;
    Buffer<float4>& start;
    Buffer<float4>& input;

    /// Neither has moved, one of them, or both.
    explicit States(KernelCase& c)
        : own(c.add<float4>("own", c.items)),
          start(c.add<float4>("start", c.items)),
          input(c.add<float4>("input", c.items)) {
        for (std::size_t v = 0; v < own.count(); ++v) {
            own[v] = start[v] = input[v] = c.random.point(1.0f);
            if (c.random.integer(0, 1) == 0) own[v] = c.random.point(1.0f);
            if (c.random.integer(0, 1) == 0) input[v] = c.random.point(1.0f);
        }
    }
};

void merge_case(KernelCase& c) {
    States s(c);
    c.launch =
        launch(kernels::merge_displacements, c.segments, s.own, s.start, s.input, 0.5f, 1.0f);
}

void average_case(KernelCase& c) {
    States s(c);
    c.launch = launch(kernels::average_positions, c.segments, s.own, s.input);
}

const bool added =
    add_case("merge_displacements", merge_case) && add_case("average_positions", average_case);

}  // namespace
}  // namespace weft::test
