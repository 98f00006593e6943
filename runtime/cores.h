#pragma once

#include <vector>

namespace weft {

/// The cores that this process may use, ascending: those of its affinity, and of these no more than
/// its quota of processor time is worth (cpu_quota.h), but one.
std::vector<int> usable_cores();

/// Keeps the calling thread on these cores; does nothing where the system cannot, or for no cores.
void pin_thread(const std::vector<int>& cores);

/// Pins the calling thread for as long as it lives, then lets it go where it could go before.
class PinnedThread {
public:
    explicit PinnedThread(const std::vector<int>& cores);
    ~PinnedThread();
    PinnedThread(const PinnedThread&) = delete;
    PinnedThread& operator=(const PinnedThread&) = delete;

private:
    std::vector<int> before_;
};

}  // namespace weft
