#include <gtest/gtest.h>

#include <filesystem>
#include <thread>
#include <utility>

#include "runtime/trace/trace_reader.h"
#include "runtime/trace/trace_writer.h"
#include "tests/runtime/trace/synthetic_run.h"

namespace weft {
namespace {

constexpr synthetic::Shape kShape{.substeps = 10, .iterations = 16};

class TraceAppend : public testing::Test {
protected:
    void TearDown() override { std::filesystem::remove(file_); }

    const std::filesystem::path file_ =
        std::filesystem::path(testing::TempDir()) / "weft_trace_append.h5";
};

/// The frame loop waits for neither; how long `append` takes tells bench_runtime.
TEST_F(TraceAppend, CopiesNothingAndWritesOnAnotherThread) {
    FrameRecord record = synthetic::frame(kShape, 0);
    const ExecutionRecord* const executions = record.executions.data();
    const ExecutionRecord* received = nullptr;
    std::thread::id writing;
    {
        TraceWriter writer(file_, synthetic::describe(kShape));
        writer.append(std::move(record), [&](FrameRecord& arrived) {
            received = arrived.executions.data();
            writing = std::this_thread::get_id();
        });
        writer.finish("");
    }
    EXPECT_EQ(received, executions);
    EXPECT_NE(writing, std::thread::id());
    EXPECT_NE(writing, std::this_thread::get_id());
}

TEST_F(TraceAppend, KeepsEveryExecution) {
    constexpr std::uint32_t kFrames = 40;
    {
        TraceWriter writer(file_, synthetic::describe(kShape));
        for (std::uint32_t i = 0; i < kFrames; ++i) writer.append(synthetic::frame(kShape, i));
        writer.finish("");
    }
    const TraceReader trace(file_);
    ASSERT_EQ(trace.frames().size(), kFrames);
    for (std::uint32_t i = 0; i < kFrames; ++i) {
        const FrameRecord expected = synthetic::frame(kShape, i);
        EXPECT_GT(expected.executions.size(), 800U);
        EXPECT_EQ(trace.frame(i).executions.size(), expected.executions.size());
        EXPECT_EQ(trace.frame(i).executions.back().end, expected.executions.back().end);
    }
}

}  // namespace
}  // namespace weft
