#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

/// What a trace holds, as plain structs: `RunDescription` once, then one `FrameRecord` per frame.
/// docs/trace-format.md documents every column. Times are seconds since the run's start (float64,
/// monotonic clock) unless a field says otherwise. Devices, kinds and energies are indices into
/// the lists of the RunDescription.

namespace weft {

/// One device of the run. Its index in RunDescription::devices is its number in every table.
struct DeviceDescription {
    std::string name;         ///< as the driver reports it
    std::string kind;         ///< "tbb" or "opencl"
    std::string driver;       ///< platform and driver version; empty for TBB
    std::uint32_t units = 0;  ///< threads or compute units in use
    std::string memory;       ///< "host" (zero copy), "mapped" or "discrete" (range copies)
    bool exact = true;        ///< rounds + - * / sqrt as strict arithmetic asks
    std::uint32_t team = 0;   ///< devices of one team work together, teams take turns
};

using TextPairs = std::vector<std::pair<std::string, std::string>>;

/// What made the run; written before the first frame and never changed.
struct RunDescription {
    std::string scene_name;
    std::string scene_path;  ///< the scene file, absolute; its meshes are relative to its folder
    std::string scene_text;  ///< the scene file, with overrides applied by `command` alone
    std::string command;     ///< the command line, words joined by blanks
    TextPairs host;          ///< e.g. {"name", "node7"}, {"cpu", "AMD EPYC 7763"}
    TextPairs versions;      ///< e.g. {"weft", "0.1.0"}, {"hdf5", "1.10.8"}
    TextPairs settings;      ///< e.g. {"math", "strict"}, {"plan", "exact"}, {"substeps", "8"}
    TextPairs meshes;  ///< bodies whose shape is a file, e.g. "cloth.shirt": hash of its bytes
    std::vector<DeviceDescription> devices;
    std::vector<std::string> kinds;     ///< names of the task kinds, e.g. "predict", "strips"
    std::vector<std::string> energies;  ///< energies the scene has besides kinetic and gravity
    std::vector<std::string> warnings;  ///< of what there was to doubt before the first frame
    /// False where all devices share memory: then there is no transfers table.
    bool has_transfers = false;
    /// False where nothing touches anything: then there is no contacts table.
    bool has_contacts = false;
};

/// One task of the plan of a frame's substeps. Every substep of a frame runs the same plan.
struct PlanRecord {
    std::uint32_t task = 0;  ///< number in the substep's task graph; executions refer to it
    std::uint32_t kind = 0;
    std::uint32_t iteration = 0;  ///< of the substep; 0 for tasks outside the iterations
    std::uint32_t first_strip = 0;
    std::uint32_t strip_count = 0;
    std::uint32_t device = 0;
    std::uint32_t home = 0;   ///< the device that was given the task's strips
    std::uint32_t order = 0;  ///< position in that device's queue
    std::uint64_t items = 0;  ///< what the cost model counts
    double start = 0.0;       ///< predicted [s], relative to the substep's start
    double end = 0.0;
};

/// `to` needs what `from` wrote.
struct DependencyRecord {
    std::uint32_t from = 0;  ///< tasks
    std::uint32_t to = 0;
    std::uint32_t carried = 0;  ///< 1: from a task of one substep to a task of the next
    double bytes = 0.0;         ///< what `to` reads of it

    friend bool operator==(const DependencyRecord&, const DependencyRecord&) = default;
};

/// What the frames of one division of the strips have in common. Frames share it, and the writer
/// writes it once.
struct GraphRecord {
    std::uint32_t graph = 0;            ///< its number, from 0
    std::vector<std::uint32_t> strips;  ///< [device] how many it is given
    std::vector<DependencyRecord> dependencies;
};

/// One task as it ran.
struct ExecutionRecord {
    std::uint32_t substep = 0;
    std::uint32_t task = 0;
    std::uint32_t device = 0;
    std::uint64_t items = 0;
    double start = 0.0;
    double end = 0.0;
};

/// The cost model's opinion of one kind on one device: time [s] = fixed + per_item * items.
struct CostRecord {
    std::uint32_t kind = 0;
    std::uint32_t device = 0;
    double fixed = 0.0;
    double per_item = 0.0;
    std::uint32_t samples = 0;  ///< executions the fit rests on
};

/// What planning took the way from one device to another to cost.
struct LinkRecord {
    std::uint32_t from = 0;  ///< devices
    std::uint32_t to = 0;
    double latency = 0.0;    ///< from a task's end to the start of one that waits for it [s]
    double bandwidth = 0.0;  ///< [bytes/s]; may be infinite
};

/// One copy between the memories of two devices, made for `task`, the task that reads the data.
struct TransferRecord {
    std::uint32_t substep = 0;
    std::uint32_t task = 0;
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    std::uint64_t bytes = 0;
    double start = 0.0;
    double end = 0.0;
};

/// What contact did in one frame.
struct ContactRecord {
    std::uint64_t pairs = 0;      ///< that might touch in a substep
    std::uint64_t rows = 0;       ///< entries of vertices for those that might push
    std::uint32_t touching = 0;   ///< vertices that a substep found nearer than the thickness
    std::uint32_t truncated = 0;  ///< vertices that were taken back in a substep
    std::uint32_t lost = 0;       ///< of these, found no place that all of their contacts allow
    std::uint32_t redone = 0;     ///< how often the frame was run again for contact
    /// With so many it would hardly have to take anybody back; 0: it has not.
    std::uint32_t substeps_wanted = 0;
    double least_distance = 0.0;  ///< of what substeps began with [m]; infinite: nothing was near
};

/// Everything about one frame; the writer takes it whole.
struct FrameRecord {
    std::uint32_t frame = 0;
    double sim_time = 0.0;  ///< simulated time at the frame's end [s]
    double start = 0.0;
    double end = 0.0;  ///< the start of the next frame: all that lies between belongs to this one
    // Where the time from start to end went: together these are all of it [s].
    double place_time = 0.0;    ///< obstacles, pins, gravity; a copy of the state to go back to
    double plan_time = 0.0;     ///< the planner
    double execute_time = 0.0;  ///< all substeps, from their submission to the state at the host
    double check_time = 0.0;    ///< whether the state is one; strain and energies
    double learn_time = 0.0;    ///< costs from what was measured, and this record
    double measure_time = 0.0;  ///< the state's hash, where it is not found out beside a frame
    double output_time = 0.0;   ///< handing over to files and waiting for them; checkpoints, talk
    double planned_makespan = 0.0;   ///< of the whole frame (all substeps) [s]
    double measured_makespan = 0.0;  ///< of the whole frame (all substeps) [s]
    double lower_bound = 0.0;        ///< no plan of this frame can be predicted faster [s]
    /// planned_makespan = pace * end of the plan's last task * substeps: how much longer than its
    /// tasks' costs say the plan was expected to take, as learnt.
    double pace = 1.0;
    std::uint64_t transferred_bytes = 0;
    std::vector<double> busy;  ///< [devices] time spent in tasks [s]
    std::string state_hash;    ///< at the frame's end, 32 hex digits; empty: not known
    std::string planner;       ///< that found the plan: "in-order", "heft", "shares", ...
    std::shared_ptr<const GraphRecord> graph;  ///< null: not known
    std::vector<PlanRecord> plan;
    std::vector<ExecutionRecord> executions;
    std::vector<CostRecord> costs;          ///< that the frame was planned with
    std::vector<LinkRecord> links;          ///< likewise; empty with a single device
    std::vector<TransferRecord> transfers;  ///< empty unless RunDescription::has_transfers
    std::vector<ContactRecord> contacts;    ///< one; none unless RunDescription::has_contacts
    std::uint32_t substeps = 0;             ///< that the frame was made of; 0: not known
    std::uint32_t iterations = 0;           ///< that each of them was solved by; 0: not known
    /// Of its last substep, (E - E*) / (E0 - E*), as estimated; NaN: not in this frame.
    double relative_error = std::numeric_limits<double>::quiet_NaN();
    // Of the state at the frame's end.
    double strain_rms = 0.0;       ///< of all edges, |length / rest length - 1|
    double strain_max = 0.0;       ///< of the worst one
    double kinetic_energy = 0.0;   ///< [J]
    double gravity_energy = 0.0;   ///< potential in gravity [J]
    double work = 0.0;             ///< by what moves by itself, since the start [J]; NaN: not known
    double dissipated = 0.0;       ///< since the start [J]; NaN: not known
    double gained = 0.0;           ///< of what was dissipated, what has come back [J]; likewise
    std::vector<double> energies;  ///< [RunDescription::energies] [J]; empty: not measured
    std::vector<std::string> warnings;  ///< of what there is to doubt in it; devices that were lost

    double wall_time() const { return end - start; }
};

/// A part of a frame's wall time.
struct FramePart {
    const char* name;
    double FrameRecord::*time;
};

inline constexpr FramePart kFrameParts[] = {
    {"placing", &FrameRecord::place_time},     {"planning", &FrameRecord::plan_time},
    {"executing", &FrameRecord::execute_time}, {"checking", &FrameRecord::check_time},
    {"learning", &FrameRecord::learn_time},    {"measuring", &FrameRecord::measure_time},
    {"output", &FrameRecord::output_time},
};

}  // namespace weft
