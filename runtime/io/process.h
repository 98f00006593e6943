#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <string_view>

namespace weft {

/// Bytes from one process to another. Both have both ends, and each closes what it does not use:
/// whoever reads is at the end once nobody can write any more.
class Pipe {
public:
    Pipe();
    ~Pipe();
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;

    /// False: the system has none to give.
    bool is_open() const { return reader_ >= 0; }
    int reader() const { return reader_; }
    int writer() const { return writer_; }
    void close_reader();
    void close_writer();

private:
    int reader_ = -1;
    int writer_ = -1;
};

/// False where nobody reads them any more (with SIGPIPE ignored).
bool write_all(int descriptor, std::string_view bytes);

/// What there is, waiting for at least one byte; empty at the end.
std::string read_some(int descriptor);

/// Starts a process that does `work`, and ends with the code that it returns and without anything
/// else of this process: neither destructors nor what is still to be written. Its number; negative
/// where none can be started, and errno says why. Call it while this process has no threads.
pid_t start_process(const std::function<int()>& work);

/// Waits for its end, and returns its status as waitpid() does.
int wait_for_process(pid_t process);

}  // namespace weft
