// The cost model's share of a frame: 1000 observations of 20 kinds on 2 devices, and one refit.

#include <benchmark/benchmark.h>

#include "scheduler/cost_model.h"

namespace weft::scheduler {
namespace {

void observe_frame(CostModel& model, std::uint32_t& execution) {
    for (int i = 0; i < 1000; ++i, ++execution) {
        const std::uint32_t kind = execution % 20;
        const double items = 1000.0 + 100.0 * (execution % 7);
        model.observe(kind, execution / 20 % 2, items, 1e-5 + 1e-8 * items);
    }
}

void cost_model_frame(benchmark::State& state) {
    CostModel model(20, 2);
    std::uint32_t execution = 0;
    for (int frame = 0; frame < 20; ++frame) {
        observe_frame(model, execution);
        model.refit();
    }
    for (auto _ : state) {
        observe_frame(model, execution);
        model.refit();
    }
}

BENCHMARK(cost_model_frame)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace weft::scheduler
