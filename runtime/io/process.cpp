#include "runtime/io/process.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

#include "runtime/io/system_call.h"

namespace weft {

namespace {

void close_end(int& end) {
    if (end >= 0) ::close(std::exchange(end, -1));
}

/// What `work` does not catch must not unwind into what the other process goes on with.
[[noreturn]] void serve(const std::function<int()>& work) noexcept { ::_exit(work()); }

}  // namespace

Pipe::Pipe() {
    int ends[2];
    if (::pipe(ends) != 0) return;
    reader_ = ends[0];
    writer_ = ends[1];
}

Pipe::~Pipe() {
    close_reader();
    close_writer();
}

void Pipe::close_reader() { close_end(reader_); }
void Pipe::close_writer() { close_end(writer_); }

bool write_all(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        const auto count =
            until_uninterrupted([&] { return ::write(descriptor, bytes.data(), bytes.size()); });
        if (count <= 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
}

std::string read_some(int descriptor) {
    char block[4096];
    const auto count = until_uninterrupted([&] { return ::read(descriptor, block, sizeof block); });
    return count > 0 ? std::string(block, static_cast<std::size_t>(count)) : "";
}

pid_t start_process(const std::function<int()>& work) {
    std::fflush(nullptr);  // or both processes would write it
    const pid_t process = ::fork();
    if (process == 0) serve(work);
    return process;
}

int wait_for_process(pid_t process) {
    int status = 0;
    until_uninterrupted([&] { return ::waitpid(process, &status, 0); });
    return status;
}

}  // namespace weft
