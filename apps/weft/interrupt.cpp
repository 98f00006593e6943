#include "apps/weft/interrupt.h"

#include <csignal>
#include <initializer_list>

namespace weft {

namespace {

volatile std::sig_atomic_t noted_signal = 0;

void note(int signal) { noted_signal = signal; }

constexpr std::initializer_list<int> kSignals{SIGINT, SIGTERM, SIGHUP};

void handle(int signal, void (*handler)(int), int flags) {
    struct sigaction action {};
    struct sigaction old {};
    action.sa_handler = handler;
    action.sa_flags = flags;
    // Whoever started us with the signal ignored (nohup, a background job) wants it so.
    if (sigaction(signal, nullptr, &old) == 0 && old.sa_handler == SIG_IGN) return;
    sigaction(signal, &action, nullptr);
}

}  // namespace

InterruptNotice::InterruptNotice() {
    noted_signal = 0;
    for (const int signal : kSignals) handle(signal, note, SA_RESTART | SA_RESETHAND);
}

InterruptNotice::~InterruptNotice() {
    for (const int signal : kSignals) handle(signal, SIG_DFL, 0);
}

int InterruptNotice::signal() const { return noted_signal; }

const char* signal_name(int signal) {
    switch (signal) {
        case SIGINT:
            return "SIGINT";
        case SIGTERM:
            return "SIGTERM";
        case SIGHUP:
            return "SIGHUP";
        default:
            return "a signal";
    }
}

}  // namespace weft
