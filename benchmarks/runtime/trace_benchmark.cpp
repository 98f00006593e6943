// What the frame loop itself spends on a trace: `append` alone, of frames as a scene of 50 ms has
// them, each given once the one before is written.

#include <benchmark/benchmark.h>

#include <filesystem>
#include <utility>

#include "runtime/trace/trace_writer.h"
#include "tests/runtime/trace/synthetic_run.h"

namespace weft {
namespace {

void append_frames(benchmark::State& state) {
    constexpr synthetic::Shape kShape{.substeps = 10, .iterations = 16};
    const auto path = std::filesystem::temp_directory_path() / "weft_trace_benchmark.h5";
    {
        TraceWriter writer(path, synthetic::describe(kShape));
        std::uint32_t number = 0;
        for (auto _ : state) {
            state.PauseTiming();
            FrameRecord record = synthetic::frame(kShape, number++);
            writer.settle();
            state.ResumeTiming();
            writer.append(std::move(record));
        }
        writer.finish("");
    }
    std::filesystem::remove(path);
}
BENCHMARK(append_frames)->Iterations(200)->UseRealTime();  // most of one is not timed

}  // namespace
}  // namespace weft
