#include "runtime/load_meter.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <ctime>
#include <fstream>
#include <latch>
#include <string>
#include <thread>
#include <vector>

#include "runtime/cores.h"
#include "tests/joining_thread.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

class LoadMeterTest : public testing::Test {
protected:
    ~LoadMeterTest() override { fs::remove(file_); }

    /// So many seconds of all cores together, evenly.
    void write(double busy) const {
        const auto cores = usable_cores();
        const double ticks =
            busy / static_cast<double>(cores.size()) * static_cast<double>(::sysconf(_SC_CLK_TCK));
        std::ofstream out(file_);
        out << "cpu  1 2 3 4 5 6 7 8 0 0\n";
        for (const int core : cores) {
            const long idle = 7 * static_cast<long>(ticks);
            out << "cpu" << core << ' ' << static_cast<long>(ticks) << " 0 0 " << idle << ' '
                << idle << " 0 0 0 0 0\n";
        }
        out << "intr 1\n";
    }

    fs::path file_ = fs::path(testing::TempDir()) / "weft_load_meter_stat";
};

void sleep(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

TEST_F(LoadMeterTest, TellsWhatOthersTake) {
    const auto cores = static_cast<double>(usable_cores().size());
    write(1000.0);
    const auto seconds = [] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
            .count();
    };
    const double before = seconds();
    LoadMeter meter(file_);
    const double made = seconds();
    sleep(0.3);
    write(1000.0 + 1e6 * cores);
    const double asked = seconds();
    const auto share = meter.others_share();
    ASSERT_TRUE(share.has_value());
    // More than there can be, as the file says: a million seconds of each core.
    EXPECT_GT(*share, 0.99e6 / (seconds() - before));
    EXPECT_LT(*share, 1.01e6 / (asked - made));
    sleep(0.3);
    const auto quiet = meter.others_share();
    ASSERT_TRUE(quiet.has_value());
    EXPECT_EQ(*quiet, 0.0);
}

TEST_F(LoadMeterTest, KnowsNothingWhereTheSystemSaysNothing) {
    LoadMeter meter(file_);
    sleep(0.25);
    EXPECT_FALSE(meter.others_share().has_value());
}

/// Each works for so long, whatever the machine does meanwhile.
void work(double seconds) {
    timespec start{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &start);
    const auto worked = [&] {
        timespec now{};
        ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
        return static_cast<double>(now.tv_sec - start.tv_sec) +
               1e-9 * static_cast<double>(now.tv_nsec - start.tv_nsec);
    };
    while (worked() < seconds) {
    }
}

TEST(ThreadsAtWork, AreCountedByWhatTheyDo) {
    const auto before = thread_times();
#ifdef __linux__
    ASSERT_FALSE(before.empty());
#endif
    if (before.empty()) GTEST_SKIP() << "the system does not tell";
    work(0.05);
    EXPECT_NEAR(threads_at_work(before, thread_times()), 1.0, 0.2);

    const auto again = thread_times();
    std::latch done(3);
    std::latch read(1);
    std::vector<JoiningThread> threads;
    for (int i = 0; i < 3; ++i) {
        threads.emplace_back([&] {
            work(0.05);
            done.count_down();
            read.wait();
        });
    }
    done.wait();
    EXPECT_NEAR(threads_at_work(again, thread_times()), 3.0, 0.3);
    read.count_down();
}

TEST(ProcessorTime, GrowsWithWork) {
    const double before = processor_time();
    volatile double sum = 0.0;
    while (processor_time() < before + 0.02) sum = sum + 1.0;
    EXPECT_GT(processor_time(), before);
}

}  // namespace
}  // namespace weft::test
