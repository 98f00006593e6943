#include "runtime/load_meter.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <sstream>
#include <string>

#include "runtime/clock.h"
#include "runtime/cores.h"

namespace weft {

namespace {

/// The system counts in hundredths of a second, so a shorter time says nothing [s].
constexpr double kShortestTime = 0.2;

/// Ticks of one core's line: user, nice, system, (idle, waiting for disks,) interrupts, and what a
/// hypervisor has given to others.
double busy_ticks(std::istringstream& line) {
    double sum = 0.0;
    double ticks = 0.0;
    for (int column = 0; column < 8 && line >> ticks; ++column) {
        if (column != 3 && column != 4) sum += ticks;
    }
    return sum;
}

}  // namespace

double processor_time() {
    timespec time{};
    if (::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time) != 0) return 0.0;
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

std::map<int, double> thread_times() {
    std::map<int, double> times;
#ifdef __linux__
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task", error)) {
        const int thread = std::atoi(entry.path().filename().c_str());
        // The clock of a thread by its number, as the kernel encodes it (CPUCLOCK_PERTHREAD_MASK
        // and CPUCLOCK_SCHED); the C library has it for its own handles only.
        const auto clock = static_cast<clockid_t>((~static_cast<unsigned>(thread) << 3U) | 6U);
        timespec time{};
        if (::clock_gettime(clock, &time) != 0) continue;  // it has ended
        times[thread] = static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    }
#endif
    return times;
}

double threads_at_work(const std::map<int, double>& before, const std::map<int, double>& after) {
    double all = 0.0;
    double most = 0.0;
    for (const auto& [thread, time] : after) {
        const auto known = before.find(thread);
        const double worked = time - (known == before.end() ? 0.0 : known->second);
        all += worked;
        most = std::max(most, worked);
    }
    return most > 0.0 ? all / most : 0.0;
}

LoadMeter::LoadMeter(std::filesystem::path stat) : stat_(std::move(stat)), last_(read()) {}

std::optional<LoadMeter::Reading> LoadMeter::read() const {
    const auto cores = usable_cores();
    Reading reading{now(), 0.0, processor_time()};
    std::size_t found = 0;
    std::ifstream file(stat_);
    for (std::string text; std::getline(file, text) && text.starts_with("cpu");) {
        std::istringstream line(text.substr(3));
        int core = -1;
        if (text[3] == ' ' || !(line >> core)) continue;  // the sum of all
        if (std::ranges::count(cores, core) == 0) continue;
        reading.busy += busy_ticks(line) / static_cast<double>(::sysconf(_SC_CLK_TCK));
        ++found;
    }
    return found == cores.size() ? std::optional(reading) : std::nullopt;
}

std::optional<double> LoadMeter::others_share() {
    if (!last_ || now() - last_->wall < kShortestTime) return std::nullopt;
    const auto reading = read();
    if (!reading) return std::nullopt;
    const double others = (reading->busy - last_->busy) - (reading->own - last_->own);
    const double all = (reading->wall - last_->wall) * static_cast<double>(usable_cores().size());
    last_ = reading;
    return std::max(0.0, others / all);
}

}  // namespace weft
