#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <thread>
#include <vector>

#include "runtime/trace/trace_writer.h"
#include "tests/runtime/trace/synthetic_run.h"

namespace weft {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds(Clock::duration duration) {
    return std::chrono::duration<double, std::milli>(duration).count();
}

/// 840 executions in a frame of 50 ms: the frame loop may lose 1 % of it.
TEST(TraceCost, AppendTakesLessThanOnePerCentOfAFrame) {
    const synthetic::Shape shape{.substeps = 10, .iterations = 16};
    const auto path = std::filesystem::path(testing::TempDir()) / "weft_trace_cost.h5";
    std::vector<double> times;
    {
        TraceWriter writer(path, synthetic::describe(shape));
        for (std::uint32_t i = 0; i < 40; ++i) {
            FrameRecord record = synthetic::frame(shape, i);
            std::this_thread::sleep_for(std::chrono::milliseconds(10));  // the simulation's work
            const auto start = Clock::now();
            writer.append(std::move(record));
            times.push_back(milliseconds(Clock::now() - start));
        }
        writer.finish("");
    }
    RecordProperty("bytes_per_frame", static_cast<int>(std::filesystem::file_size(path) / 40));
    std::filesystem::remove(path);
    std::nth_element(times.begin(), times.begin() + 20, times.end());
    EXPECT_LT(times[20], 0.5) << "ms, median";
}

}  // namespace
}  // namespace weft
