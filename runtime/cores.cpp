#include "runtime/cores.h"

#include <thread>

#ifdef __linux__
#include <sched.h>
#endif

namespace weft {

std::vector<int> usable_cores() {
    std::vector<int> cores;
#ifdef __linux__
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) == 0) {
        for (int core = 0; core < CPU_SETSIZE; ++core) {
            if (CPU_ISSET(core, &set)) cores.push_back(core);
        }
    }
#endif
    if (cores.empty()) {
        const int count = static_cast<int>(std::thread::hardware_concurrency());
        for (int core = 0; core < (count > 0 ? count : 1); ++core) cores.push_back(core);
    }
    return cores;
}

void pin_thread([[maybe_unused]] const std::vector<int>& cores) {
#ifdef __linux__
    if (cores.empty()) return;
    cpu_set_t set;
    CPU_ZERO(&set);
    for (const int core : cores) CPU_SET(core, &set);
    sched_setaffinity(0, sizeof set, &set);  // a hint: without it only the speed may suffer
#endif
}

PinnedThread::PinnedThread(const std::vector<int>& cores) {
    if (cores.empty()) return;
    before_ = usable_cores();
    pin_thread(cores);
}

PinnedThread::~PinnedThread() { pin_thread(before_); }

}  // namespace weft
