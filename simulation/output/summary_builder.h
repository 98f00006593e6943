#pragma once

#include <array>
#include <cstdint>
#include <iterator>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "simulation/output/summary.h"

namespace weft {

/// Gathers a summary frame by frame; keeps a few numbers of each.
class SummaryBuilder {
public:
    explicit SummaryBuilder(const RunDescription& run);

    void add(const FrameRecord& frame);
    /// What to doubt in the results, besides what the caller adds.
    void warn(std::string what) { summary_.warnings.push_back(std::move(what)); }

    /// The summary so far; state_hash and files are the caller's to fill.
    RunSummary summary() const;

    /// When the last frame ended [s].
    double end() const { return frames_.empty() ? 0.0 : frames_.back().end; }
    /// All that was gathered, for a checkpoint.
    std::vector<std::uint8_t> save() const;
    /// Goes on from there; before the first add(). Devices that the run has no more keep their rows
    /// behind those that it has. Throws UserError if it was not made by save().
    void restore(std::span<const std::uint8_t> saved);

private:
    struct Kept;
    struct Frame {
        double start, end;
        double planned, measured, lower_bound;  ///< makespans
        std::array<double, std::size(kFrameParts)> parts;
    };
    struct Estimate {
        std::size_t frame;
        double relative_error;
    };

    void sum_up_estimates(RunSummary& summary) const;
    void restore_device(const RunSummary::Device& device);
    void set_energies(const FrameRecord& frame);
    void add_strain(const FrameRecord& frame);
    void add_contact(const FrameRecord& frame);

    RunSummary summary_;
    std::vector<std::string> energy_names_;
    std::size_t device_count_;  ///< that take part now: the first rows
    std::vector<Frame> frames_;
    std::vector<Estimate> estimates_;
};

}  // namespace weft
