#pragma once

#include <optional>

namespace weft::batch {

/// While one lives, the signals that engines end a job with (SIGTERM, SIGUSR1, SIGHUP, SIGINT) are
/// only noted, however often they come, and so is the end of a child. One at a time.
class StopNotice {
public:
    StopNotice();
    ~StopNotice();
    StopNotice(const StopNotice&) = delete;
    StopNotice& operator=(const StopNotice&) = delete;

    int signal() const;      ///< that came first; 0: none
    int interrupts() const;  ///< how often SIGINT came
    /// Returns when something has come, a child has ended, or so many seconds are over.
    void wait(std::optional<double> seconds) const;

    /// In a child: signals do what they do by default, and are let through.
    static void forget();
    /// Holds signals back around a fork, so that none is lost to handlers of the wrong process.
    static void hold_back(bool yes);
};

/// Whether a signal asks a program to end in good order.
bool asks_to_stop(int signal);

}  // namespace weft::batch
