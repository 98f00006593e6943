#include "runtime/cores.h"

#include <algorithm>

#include <optional>
#include <thread>

#include "runtime/cpu_quota.h"

#ifdef __linux__
#include <sched.h>
#endif

namespace weft {

namespace {

/// The cores that the calling thread may run on.
std::vector<int> allowed_cores() {
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

/// The first core that is taken where not all may be: the one that we run on at first, so that
/// several containers of one machine do not all take the same ones.
int first_core() {
#ifdef __linux__
    static const int core = sched_getcpu();
    return core;
#else
    return 0;
#endif
}

}  // namespace

std::vector<int> usable_cores() {
    std::vector<int> cores = allowed_cores();
    static const std::optional<double> quota = cpu_quota();
    const auto count = static_cast<std::size_t>(std::max(1.0, quota.value_or(1e9)));
    if (count >= cores.size()) return cores;
    const auto first = std::ranges::find_if(cores, [](int core) { return core >= first_core(); });
    std::ranges::rotate(cores, first);
    cores.resize(count);
    std::ranges::sort(cores);
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
    before_ = allowed_cores();
    pin_thread(cores);
}

PinnedThread::~PinnedThread() { pin_thread(before_); }

}  // namespace weft
