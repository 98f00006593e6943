#include "apps/weft/batch/stop_notice.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <initializer_list>

#include "runtime/error.h"

namespace weft::batch {

namespace {

constexpr std::initializer_list<int> kStops{SIGTERM, SIGUSR1, SIGHUP, SIGINT};

volatile std::sig_atomic_t first_signal = 0;
volatile std::sig_atomic_t interrupt_count = 0;
int pipe_ends[2] = {-1, -1};  // what comes is told through it, so that poll() can wait for it

void note(int signal) {
    const int before = errno;
    if (signal != SIGCHLD && first_signal == 0) first_signal = signal;
    if (signal == SIGINT) interrupt_count = interrupt_count + 1;
    [[maybe_unused]] const ssize_t sent = ::write(pipe_ends[1], "", 1);
    errno = before;
}

void handle(int signal, void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    sigaction(signal, &action, nullptr);
}

/// Whoever started us with the signal ignored (nohup, a background job) wants it so.
bool is_ignored(int signal) {
    struct sigaction old {};
    return sigaction(signal, nullptr, &old) == 0 && old.sa_handler == SIG_IGN;
}

void handle_all(void (*handler)(int)) {
    for (const int signal : kStops) {
        if (!is_ignored(signal)) handle(signal, handler);
    }
}

}  // namespace

StopNotice::StopNotice() {
    first_signal = 0;
    interrupt_count = 0;
    if (::pipe(pipe_ends) != 0) throw RunError("cannot make a pipe");
    for (const int end : pipe_ends) {
        ::fcntl(end, F_SETFL, O_NONBLOCK);
        ::fcntl(end, F_SETFD, FD_CLOEXEC);
    }
    handle_all(note);
    handle(SIGCHLD, note);
}

/// Once one has come the program is on its way out: further ones of those that batch systems send
/// several of do not end it before it has said so.
StopNotice::~StopNotice() {
    handle_all(first_signal != 0 ? SIG_IGN : SIG_DFL);
    handle(SIGCHLD, SIG_DFL);
    for (const int end : pipe_ends) ::close(end);
}

int StopNotice::signal() const { return first_signal; }
int StopNotice::interrupts() const { return interrupt_count; }

void StopNotice::wait(std::optional<double> seconds) const {
    constexpr double kLongest = 3600.0;
    struct pollfd in {
        pipe_ends[0], POLLIN, 0
    };
    const double limit = std::clamp(seconds.value_or(kLongest), 0.0, kLongest);
    if (::poll(&in, 1, static_cast<int>(std::ceil(1e3 * limit))) <= 0) return;
    char ignored[64];
    while (::read(pipe_ends[0], ignored, sizeof ignored) > 0) {
    }
}

void StopNotice::forget() {
    handle_all(SIG_DFL);
    handle(SIGCHLD, SIG_DFL);
}

void StopNotice::hold_back(bool yes) {
    sigset_t set;
    sigemptyset(&set);
    for (const int signal : kStops) sigaddset(&set, signal);
    sigprocmask(yes ? SIG_BLOCK : SIG_UNBLOCK, &set, nullptr);
}

bool asks_to_stop(int signal) { return std::ranges::find(kStops, signal) != kStops.end(); }

}  // namespace weft::batch
