#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/trace/records.h"

namespace weft {

/// What a run says at its end, on the terminal and in summary.json.
struct RunSummary {
    struct Device {
        std::string name;
        std::string kind;
        std::uint32_t units = 0;
        double busy = 0.0;         ///< time spent in tasks, all frames [s]
        double utilisation = 0.0;  ///< busy / measured makespan of all frames
        double share = 1.0;        ///< of its team, of which one works at a time: 1 / its devices
    };

    /// What contact did; the most of any frame where nothing else is said.
    struct Contact {
        std::uint64_t pairs = 0;
        std::uint32_t touching = 0;         ///< vertices
        std::uint32_t truncated = 0;        ///< vertices,
        std::size_t truncated_frame = 0;    ///< in this frame
        std::uint32_t lost = 0;             ///< vertices
        std::uint32_t substeps_wanted = 0;  ///< 0: nobody was taken back
        std::size_t redone = 0;             ///< frames that were run again
        double least_distance = 0.0;        ///< of all frames [m]; infinite: nothing was near
    };

    std::string scene;
    std::string command;
    TextPairs settings, host, versions;  ///< as in RunDescription
    std::size_t frames = 0;
    double simulated_time = 0.0;  ///< [s]
    double wall_time = 0.0;       ///< from the first frame's start to the last one's end [s]
    double frame_median = 0.0;    ///< from one frame's begin to the next one's, all included [s]
    double frame_p95 = 0.0;       ///< [s]
    std::array<double, std::size(kFrameParts)> parts{};  ///< medians [s]
    double planned_makespan = 0.0;                       ///< median over frames [s]
    double measured_makespan = 0.0;                      ///< median over frames [s]
    double plan_error = 0.0;                             ///< median |measured - planned| / planned
    double lower_bound = 0.0;                            ///< median over frames [s]
    std::uint64_t transferred_bytes = 0;                 ///< all frames
    double utilisation = 0.0;                            ///< mean over devices
    std::vector<Device> devices;
    std::vector<std::pair<std::string, double>> energies;  ///< at the end [J]; the last is "total"
    double work = 0.0;             ///< by what moves by itself, all frames [J]; NaN: not known
    double dissipated = 0.0;       ///< all frames [J]; NaN: not known
    double gained = 0.0;           ///< from nowhere, in the worst frame [J]
    std::size_t gained_frame = 0;  ///< that frame
    // Of edges, |length / rest length - 1|.
    double strain_rms = 0.0;         ///< of all, in the frame in which it is most
    std::size_t strain_frame = 0;    ///< that frame
    double strain_max = 0.0;         ///< of the worst edge of all frames
    double strain_rms_at_end = 0.0;  ///< of all, after the last frame
    // How far steps were solved, of frames in which that was estimated.
    std::size_t estimates = 0;          ///< such frames
    double relative_error = 0.0;        ///< median
    double worst_relative_error = 0.0;  ///< and in the worst frame,
    std::size_t worst_error_frame = 0;  ///< which is this one
    std::optional<Contact> contact;     ///< none: nothing touches anything
    std::vector<std::string> warnings;  ///< what to doubt in the results
    std::vector<std::string> losses;    ///< devices that failed in mid-run, and why
    bool finished = false;              ///< all frames of the scene are done
    std::string state_hash;             ///< after the last frame; empty: not known
    TextPairs made_from;                ///< what the results depend on, by name; in this order
    std::vector<std::pair<std::string, std::string>> files;  ///< what, and its path
};

nlohmann::ordered_json to_json(const RunSummary& summary);
std::string to_text(const RunSummary& summary);

/// Writes summary.json as a whole or not at all. Throws RunError.
void write_summary(const std::filesystem::path& path, const RunSummary& summary);

}  // namespace weft
