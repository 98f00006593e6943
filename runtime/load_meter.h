#pragma once

#include <filesystem>
#include <map>
#include <optional>

namespace weft {

/// How busy others keep the cores that this process may use. What is measured while they do says
/// more of them than of the devices.
class LoadMeter {
public:
    /// stat  where the system counts its cores' time (Linux); elsewhere nothing is known
    explicit LoadMeter(std::filesystem::path stat = "/proc/stat");

    /// The part of the cores' time that others have taken since the last answer; none where it
    /// cannot be known, or too little time has passed to say.
    std::optional<double> others_share();

private:
    struct Reading {
        double wall = 0.0;  ///< [s]
        double busy = 0.0;  ///< all cores together, whoever it was [s]
        double own = 0.0;   ///< [s]
    };
    std::optional<Reading> read() const;

    std::filesystem::path stat_;
    std::optional<Reading> last_;
};

/// Processor time of all threads of this process so far [s].
double processor_time();

/// What each of the process's threads has worked so far [thread id: s]; empty where the system does
/// not tell (it does on Linux).
std::map<int, double> thread_times();

/// How many threads shared the work between two readings, however much others kept them from it:
/// all that was worked / the most that one thread did. 0 if nothing was.
double threads_at_work(const std::map<int, double>& before, const std::map<int, double>& after);

}  // namespace weft
