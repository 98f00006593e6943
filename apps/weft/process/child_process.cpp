#include "apps/weft/process/child_process.h"

#include <cstdio>

#include "apps/weft/process/answer.h"
#include "runtime/error.h"
#include "runtime/io/process.h"

namespace weft {

namespace {

std::string read_all(int in) {
    std::string text;
    for (std::string part = read_some(in); !part.empty(); part = read_some(in)) text += part;
    return text;
}

}  // namespace

std::string in_child_process(const std::string& what, const std::function<std::string()>& work) {
    Pipe pipe;
    if (!pipe.is_open()) throw RunError("cannot make a pipe");
    const pid_t process = start_process([&] {
        pipe.close_reader();
        write_all(pipe.writer(), answer_of(work));
        std::fflush(nullptr);
        return 0;
    });
    if (process < 0) throw RunError("cannot start a process");
    pipe.close_writer();
    const std::string answer = read_all(pipe.reader());
    pipe.close_reader();
    wait_for_process(process);
    if (answer.empty()) throw RunError(what + ": the process that ran it was killed");
    return result_of(answer, what);
}

}  // namespace weft
