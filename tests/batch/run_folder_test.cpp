#include "apps/weft/batch/run_folder.h"

#include <csignal>
#include <cstdlib>

#include "apps/weft/batch/deadline.h"
#include "apps/weft/batch/verdict.h"
#include "sweep_text.h"

namespace weft::batch {
namespace {

class Folder : public InFolder {};

TEST_F(Folder, TheLockTellsRunningFromLost) {
    const RunFolder run(folder_);
    EXPECT_EQ(run.status().state, State::kWaiting);
    Status status;
    status.state = State::kRunning;
    status.attempts = 2;
    {
        FolderLock lock;
        ASSERT_TRUE(lock.take(folder_));
        EXPECT_EQ(run.status().state, State::kRunning);
        run.write(status);
        FolderLock other;
        EXPECT_FALSE(other.take(folder_));
        EXPECT_EQ(run.status_under_lock().state, State::kLost);
    }
    EXPECT_EQ(run.status().state, State::kLost);
    EXPECT_EQ(run.status().attempts, 2);
    FolderLock again;
    EXPECT_TRUE(again.take(folder_));
}

TEST_F(Folder, StatusIsReadBack) {
    const RunFolder run(folder_);
    const Status status{State::kFailed, 1,     "a \"word\"", 3,     "host", 2,
                        "slurm",        "7_1", "0.1",        100.5, 101.5,  1.0};
    run.write(status);
    const Status back = run.status();
    EXPECT_EQ(back.state, State::kFailed);
    EXPECT_EQ(back.exit_code, 1);
    EXPECT_EQ(back.why, status.why);
    EXPECT_EQ(back.attempts, 3);
    EXPECT_EQ(back.job, "7_1");
    EXPECT_EQ(back.end, 101.5);
}

TEST(States, AreParsed) {
    EXPECT_EQ(parse_states("lost,failed", "--state"),
              (std::vector<State>{State::kLost, State::kFailed}));
    EXPECT_NE(message_of([] { parse_states("finishd", "--state"); }).find("finished"),
              std::string::npos);
}

TEST_F(Folder, VerdictsFollowTheEndOfTheChild) {
    const std::string log = write("log.txt", "weft: error: of the run before\n");
    const LastWords words(log);
    const auto verdict = [&](int code, int signal, bool asked) {
        return verdict_of({code, signal, asked}, words);
    };
    EXPECT_EQ(verdict(0, 0, false).state, State::kFinished);
    EXPECT_EQ(verdict(0, 0, true).state, State::kFinished);
    for (const int signal : {SIGTERM, SIGUSR1, SIGHUP, SIGINT}) {
        EXPECT_EQ(verdict(128 + signal, 0, false).state, State::kStopped);
        EXPECT_EQ(verdict(0, signal, false).exit_code, 75);
    }
    EXPECT_EQ(verdict(0, SIGKILL, true).state, State::kStopped);
    EXPECT_EQ(verdict(0, SIGKILL, false).state, State::kFailed);
    EXPECT_EQ(verdict(0, SIGSEGV, false).exit_code, 1);
    EXPECT_EQ(verdict(134, 0, false).exit_code, 1);
    EXPECT_EQ(verdict(2, 0, false).exit_code, 2);
    EXPECT_EQ(verdict(1, 0, false).why, "");
    std::ofstream(log, std::ios::app) << "weft: error: diverged\nand more\n";
    EXPECT_EQ(verdict(1, 0, false).why, "diverged");
}

TEST(Deadline, LeavesTimeToStop) {
    EXPECT_DOUBLE_EQ(stopping_margin(1.0), 0.5);
    EXPECT_DOUBLE_EQ(stopping_margin(10.0), 1.0);
    EXPECT_DOUBLE_EQ(stopping_margin(600.0), 30.0);
    EXPECT_DOUBLE_EQ(stopping_margin(86400.0), 60.0);
    EXPECT_FALSE(Deadline(100.0).is_over());
    EXPECT_TRUE(Deadline(1e-9).is_over());
    ::setenv("SLURM_JOB_END_TIME", "1000", 1);
    EXPECT_TRUE(Deadline(std::nullopt).is_over());
    ::unsetenv("SLURM_JOB_END_TIME");
    EXPECT_FALSE(Deadline(std::nullopt).seconds_left().has_value());
}

}  // namespace
}  // namespace weft::batch
