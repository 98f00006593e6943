#pragma once

#include <stdexcept>
#include <string>

namespace weft {

/// A run that was asked to stop, and did so in good order. The program ends with 128 + signal.
class Interrupted : public std::runtime_error {
public:
    Interrupted(int signal, const std::string& message)
        : std::runtime_error(message), signal_(signal) {}
    int signal() const { return signal_; }

private:
    int signal_;
};

/// While one lives, SIGINT, SIGTERM, SIGHUP and SIGUSR1 are only noted, the first of them for
/// signal(); a second SIGINT ends the program at once. If one was noted, that stays so after its
/// end: nothing but a second SIGINT disturbs a program that is stopping. One at a time.
class InterruptNotice {
public:
    InterruptNotice();
    ~InterruptNotice();
    InterruptNotice(const InterruptNotice&) = delete;
    InterruptNotice& operator=(const InterruptNotice&) = delete;

    int signal() const;  ///< 0: none came
};

/// "SIGINT" and so on.
const char* signal_name(int signal);

}  // namespace weft
