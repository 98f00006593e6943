#include "apps/weft/process/child_process.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>

#include "runtime/error.h"
#include "runtime/io/system_call.h"

namespace weft {

namespace {

// An answer's first byte: what happened.
constexpr char kDone = '+';
constexpr char kUserError = 'u';
constexpr char kRunError = '!';

std::string answer_of(const std::function<std::string()>& work) {
    try {
        return kDone + work();
    } catch (const UserError& error) {
        return kUserError + std::string(error.what());
    } catch (const std::exception& error) {
        return kRunError + std::string(error.what());
    }
}

[[noreturn]] void serve(int out, const std::function<std::string()>& work) {
    const std::string answer = answer_of(work);
    std::size_t sent = 0;
    while (sent < answer.size()) {
        const ssize_t count = until_uninterrupted(
            [&] { return ::write(out, answer.data() + sent, answer.size() - sent); });
        if (count <= 0) break;  // whoever asked is gone
        sent += static_cast<std::size_t>(count);
    }
    std::fflush(nullptr);
    ::_exit(0);
}

std::string read_all(int in) {
    std::string text;
    char block[4096];
    while (true) {
        const auto count = until_uninterrupted([&] { return ::read(in, block, sizeof block); });
        if (count <= 0) return text;
        text.append(block, static_cast<std::size_t>(count));
    }
}

}  // namespace

std::string in_child_process(const std::string& what, const std::function<std::string()>& work) {
    int pipe[2];
    if (::pipe(pipe) != 0) throw RunError("cannot make a pipe");
    std::fflush(nullptr);
    const pid_t process = ::fork();
    if (process < 0) throw RunError("cannot start a process");
    if (process == 0) {
        ::close(pipe[0]);
        serve(pipe[1], work);
    }
    ::close(pipe[1]);
    const std::string answer = read_all(pipe[0]);
    ::close(pipe[0]);
    until_uninterrupted([&] { return ::waitpid(process, nullptr, 0); });
    if (answer.empty()) throw RunError(what + ": the process that ran it was killed");
    if (answer[0] == kUserError) throw UserError(answer.substr(1));
    if (answer[0] == kRunError) throw RunError(what + ": " + answer.substr(1));
    return answer.substr(1);
}

}  // namespace weft
