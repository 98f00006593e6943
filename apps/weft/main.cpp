#include <csignal>

#include "apps/weft/program.h"
#include "runtime/unused_memory.h"

int main(int argc, char** argv) {
    // A file that may grow no further is an error of the write, with a message, like a full disk.
    std::signal(SIGXFSZ, SIG_IGN);
    weft::give_back_large_lists();
    return weft::run_program(argc, argv);
}
