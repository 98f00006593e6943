#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "runtime/device.h"
#include "runtime/planning/timing_model.h"

namespace weft {

/// What earlier runs learnt about devices: one file for all runs of a user. A fit belongs to a
/// device, its driver, its units, and the text of all kernels: when any of these changes, it is not
/// found any more.
class SavedCosts {
public:
    /// Reads the file; one that is missing or damaged counts as empty.
    explicit SavedCosts(std::filesystem::path path);

    /// Gives the model what is known. Whether that is everything.
    /// bodies  of all task kinds; strict: the arithmetic that they run with
    bool restore(std::span<const TaskBody* const> bodies, const std::vector<Device*>& devices,
                 bool strict, TimingModel& timing) const;

    /// Takes over what the model knows by now and writes the file, with what other runs have
    /// written there meanwhile. A file that cannot be written is passed over.
    void save(std::span<const TaskBody* const> bodies, const std::vector<Device*>& devices,
              bool strict, const TimingModel& timing);

    /// Leaves the file as others have written it; makes one that knows nothing where there is none.
    void keep();

private:
    void read();
    void write() const;

    std::filesystem::path path_;
    std::map<std::string, scheduler::CostFit> fits_;  ///< [key of a kind on a device]
    std::map<std::string, double> latencies_;         ///< [key of two devices] [s]
};

}  // namespace weft
