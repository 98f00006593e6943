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

/// While one lives, the first SIGINT, SIGTERM or SIGHUP is only noted; another one of the same kind
/// ends the program as if nobody had been listening. One at a time.
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
