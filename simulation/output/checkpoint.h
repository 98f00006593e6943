#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runtime/trace/records.h"

namespace weft {

/// The state of a run between two frames.
struct Checkpoint {
    int frame = 0;                                ///< the next one
    int substeps = 0;                             ///< that its steps are made of
    int iterations = 0;                           ///< of each step
    int failed_iterations = 0;                    ///< too few for the tolerance, as was seen
    int tolerance_told = 0;                       ///< 1: the run has warned of it, as it does once
    std::array<double, 8> account{};              ///< as EnergyAccount::save() gives it
    std::vector<std::vector<std::byte>> buffers;  ///< as Simulation::checkpoint() gives them
    std::vector<std::uint8_t> report;             ///< as SummaryBuilder::save() gives it
};

/// Writes it beside the file first, then takes the file's name: whole or not at all, and a killed
/// run leaves the one before. origin: what the run was made from, by name. Throws RunError.
void write_checkpoint(const std::filesystem::path& path, const TextPairs& origin,
                      const Checkpoint& checkpoint);

/// None if the file is missing. Throws UserError if it is no checkpoint, is damaged, or was made
/// from something else, with the names of what differs.
std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& path,
                                          const TextPairs& origin);

}  // namespace weft
