#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <vector>

#include "runtime/trace/trace_reader.h"
#include "runtime/trace/trace_writer.h"
#include "tests/runtime/trace/synthetic_run.h"

namespace weft {
namespace {

/// Processor time of this thread: other programs do not change it. [s]
double thread_time() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// What the frame loop itself spends on a trace, while another thread writes.
TEST(TraceCost, AppendTakesLessThanOnePerCentOfAFrame) {
    constexpr double kFrame = 50e-3;  // of a scene with so many executions
    constexpr std::uint32_t kFrames = 40;
    const synthetic::Shape shape{.substeps = 10, .iterations = 16};
    const auto path = std::filesystem::path(testing::TempDir()) / "weft_trace_cost.h5";
    std::vector<double> times;
    {
        TraceWriter writer(path, synthetic::describe(shape));
        for (std::uint32_t i = 0; i < kFrames; ++i) {
            FrameRecord record = synthetic::frame(shape, i);
            const double start = thread_time();
            writer.append(std::move(record));
            times.push_back(thread_time() - start);
        }
        writer.finish("");
    }
    const auto median = times.begin() + kFrames / 2;
    std::nth_element(times.begin(), median, times.end());
    EXPECT_LT(*median, 0.01 * kFrame);

    // All of it is there: nothing was saved by leaving something out.
    const TraceReader trace(path);
    ASSERT_EQ(trace.frames().size(), kFrames);
    for (std::uint32_t i = 0; i < kFrames; ++i) {
        const FrameRecord expected = synthetic::frame(shape, i);
        EXPECT_GT(expected.executions.size(), 800U);
        EXPECT_EQ(trace.frame(i).executions.size(), expected.executions.size());
        EXPECT_EQ(trace.frame(i).executions.back().end, expected.executions.back().end);
    }
    RecordProperty("bytes_per_frame", static_cast<int>(std::filesystem::file_size(path) / kFrames));
    std::filesystem::remove(path);
}

}  // namespace
}  // namespace weft
