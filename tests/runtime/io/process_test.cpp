#include "runtime/io/process.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>

namespace weft {
namespace {

std::string read_all(int descriptor) {
    std::string text;
    for (auto part = read_some(descriptor); !part.empty(); part = read_some(descriptor))
        text += part;
    return text;
}

TEST(Process, EndsWithTheCodeOfItsWork) {
    const pid_t process = start_process([] { return 7; });
    ASSERT_GT(process, 0);
    const int status = wait_for_process(process);
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 7);
}

TEST(Process, SaysWhichSignalKilledIt) {
    const pid_t process = start_process([] { return ::raise(SIGKILL); });
    ASSERT_GT(process, 0);
    const int status = wait_for_process(process);
    EXPECT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), SIGKILL);
}

TEST(Pipe, CarriesMoreThanTheSystemKeepsForIt) {
    const std::string sent(1'000'000, 'x');
    Pipe pipe;
    ASSERT_TRUE(pipe.is_open());
    const pid_t process =
        start_process([&] { return write_all(pipe.writer(), sent + "end") ? 0 : 1; });
    ASSERT_GT(process, 0);
    pipe.close_writer();
    EXPECT_EQ(read_all(pipe.reader()), sent + "end");
    EXPECT_EQ(wait_for_process(process), 0);
}

TEST(Pipe, TellsTheWriterThatNobodyReads) {
    const auto before = std::signal(SIGPIPE, SIG_IGN);
    Pipe pipe;
    ASSERT_TRUE(pipe.is_open());
    pipe.close_reader();
    EXPECT_FALSE(write_all(pipe.writer(), "a word"));
    std::signal(SIGPIPE, before);
}

volatile std::sig_atomic_t alarms = 0;

TEST(Pipe, WaitsThroughASignal) {
    struct sigaction action {};
    struct sigaction before {};
    action.sa_handler = [](int) { alarms = alarms + 1; };  // and no SA_RESTART
    ASSERT_EQ(sigaction(SIGUSR2, &action, &before), 0);
    const pid_t parent = ::getpid();
    Pipe pipe;
    ASSERT_TRUE(pipe.is_open());
    const pid_t process = start_process([&] {
        ::usleep(100'000);  // until it reads
        ::kill(parent, SIGUSR2);
        ::usleep(100'000);
        return write_all(pipe.writer(), "late") ? 0 : 1;
    });
    ASSERT_GT(process, 0);
    pipe.close_writer();
    EXPECT_EQ(read_all(pipe.reader()), "late");
    EXPECT_EQ(alarms, 1);
    EXPECT_EQ(wait_for_process(process), 0);
    sigaction(SIGUSR2, &before, nullptr);
}

}  // namespace
}  // namespace weft
