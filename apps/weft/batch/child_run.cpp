#include "apps/weft/batch/child_run.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>

#ifdef __linux__
#include <sys/prctl.h>
#endif

#include "runtime/error.h"
#include "runtime/io/process.h"

namespace weft::batch {

namespace {

/// Should this driver be killed, its child ends in good order.
void end_with_parent(pid_t parent) {
#ifdef __linux__
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
#endif
    if (::getppid() != parent) ::_exit(EXIT_FAILURE);
}

int serve(int log, pid_t parent, const ChildRun::Work& work) {
    StopNotice::forget();
    StopNotice::hold_back(false);
    end_with_parent(parent);
    ::dup2(log, STDOUT_FILENO);
    ::dup2(log, STDERR_FILENO);
    const int code = work();
    std::cout.flush();
    std::cerr.flush();
    std::fflush(nullptr);
    return code;
}

ChildEnd end_of(int status, bool asked) {
    if (WIFSIGNALED(status)) return {0, WTERMSIG(status), asked};
    return {WEXITSTATUS(status), 0, asked};
}

}  // namespace

ChildRun::ChildRun(const std::filesystem::path& log, const Work& work) {
    const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (file < 0) throw RunError(log.string() + ": cannot be written: " + std::strerror(errno));
    StopNotice::hold_back(true);
    const pid_t parent = ::getpid();
    process_ = start_process([&] { return serve(file, parent, work); });
    StopNotice::hold_back(false);
    ::close(file);
    if (process_ < 0)
        throw RunError(std::string("cannot start a process: ") + std::strerror(errno));
}

ChildEnd ChildRun::wait(const StopNotice& notice,
                        const std::function<std::optional<double>()>& seconds_left) {
    bool asked = false;
    while (true) {
        int status = 0;
        const pid_t ended = ::waitpid(process_, &status, WNOHANG);
        if (ended == process_) return end_of(status, asked);
        if (ended < 0 && errno != EINTR) throw RunError("the process of a run is gone");
        const std::optional<double> left = seconds_left();
        if (!asked && (notice.signal() != 0 || (left && *left <= 0.0))) {
            ::kill(process_, SIGTERM);
            asked = true;
        }
        if (notice.interrupts() > 1) ::kill(process_, SIGKILL);
        notice.wait(asked ? std::nullopt : left);
    }
}

}  // namespace weft::batch
