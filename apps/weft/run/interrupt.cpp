#include "apps/weft/run/interrupt.h"

#include <csignal>
#include <initializer_list>

namespace weft {

namespace {

volatile std::sig_atomic_t noted_signal = 0;

void note(int signal) {
    if (noted_signal == 0) noted_signal = signal;
}

/// From programs, which may send several (srun and GNU parallel do so within 350 ms): these never
/// end the program once it is stopping. SIGUSR1 is what batch systems send before the time is up.
constexpr std::initializer_list<int> kPoliteSignals{SIGTERM, SIGHUP, SIGUSR1};

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
    handle(SIGINT, note, SA_RESTART | SA_RESETHAND);
    for (const int signal : kPoliteSignals) handle(signal, note, SA_RESTART);
}

/// After one has come they stay noted: the program is on its way out.
InterruptNotice::~InterruptNotice() {
    if (noted_signal != 0) return;
    handle(SIGINT, SIG_DFL, 0);
    for (const int signal : kPoliteSignals) handle(signal, SIG_DFL, 0);
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
        case SIGUSR1:
            return "SIGUSR1";
        default:
            return "a signal";
    }
}

}  // namespace weft
