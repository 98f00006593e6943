#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/io/hdf5.h"
#include "runtime/trace/records.h"

/// The columns of a trace's tables: one definition for writer and reader. The library matches
/// columns by name, so a reader of an older or newer Weft finds those it knows.

namespace weft::trace {

inline constexpr const char* kFormatName = "weft-trace";
inline constexpr int kFormatVersion = 1;
/// In `frames`: the frame's graph was not recorded.
inline constexpr std::uint32_t kNoGraph = 0xffffffff;

/// A row as it lies in memory: the frame (or graph) that it belongs to, then the record.
template <class Record>
struct Row {
    std::uint32_t owner = 0;
    Record record;
};

/// The columns of `frames` whose number does not depend on the run; busy_0, busy_1, ... follow.
struct FrameColumns {
    std::uint32_t frame = 0;
    double sim_time = 0.0;
    double start = 0.0;
    double end = 0.0;
    double planned_makespan = 0.0;
    double measured_makespan = 0.0;
    double lower_bound = 0.0;
    double plan_time = 0.0;
    double place_time = 0.0;
    double execute_time = 0.0;
    double check_time = 0.0;
    double learn_time = 0.0;
    double measure_time = 0.0;
    double output_time = 0.0;
    double pace = 0.0;  ///< 0: not known
    double strain_rms = 0.0;
    double strain_max = 0.0;
    double work = 0.0;
    double dissipated = 0.0;
    double relative_error = 0.0;
    std::uint64_t transferred_bytes = 0;
    std::uint32_t graph = 0;
    std::uint32_t substeps = 0;         ///< 0: not known
    std::uint32_t iterations = 0;       ///< 0: not known
    std::array<char, 16> planner{};     ///< filled up with zeros
    std::array<char, 32> state_hash{};  ///< all zero: not known
};

/// What to doubt in a frame.
struct WarningRecord {
    std::array<char, 512> text{};  ///< filled up with zeros
};

/// How many strips a graph gives to a device.
struct DivisionRecord {
    std::uint32_t device = 0;
    std::uint32_t strips = 0;
};

/// The columns of `energies` that every run has, in joules; one per energy of the scene and
/// `total` follow.
struct EnergyColumns {
    std::uint32_t frame = 0;
    double kinetic = 0.0;
    double gravity = 0.0;
};

/// A compound type over a C++ struct, with `doubles` appended behind it, all of one unit.
class RowType {
public:
    struct Column {
        std::string name;
        hid_t type;
        std::size_t offset;
        const char* unit = "";
    };

    RowType(std::size_t struct_size, std::vector<Column> columns,
            const std::vector<std::string>& doubles = {}, const char* unit = "");

    hid_t memory() const { return memory_.id(); }
    hid_t file() const { return file_.id(); }              ///< the same columns without gaps
    hid_t owner_only() const { return owner_only_.id(); }  ///< its first column alone
    std::size_t size() const { return size_; }             ///< of a row in memory [bytes]
    const std::vector<std::string>& units() const { return units_; }  ///< [column]

private:
    std::size_t size_;
    std::vector<std::string> units_;
    hdf5::Handle memory_;
    hdf5::Handle file_;
    hdf5::Handle owner_only_;
};

RowType frame_row_type(std::size_t device_count);
RowType energy_row_type(const std::vector<std::string>& energies);
RowType plan_row_type();       ///< Row<PlanRecord>
RowType execution_row_type();  ///< Row<ExecutionRecord>
RowType cost_row_type();       ///< Row<CostRecord>
RowType link_row_type();       ///< Row<LinkRecord>
RowType transfer_row_type();   ///< Row<TransferRecord>
RowType contact_row_type();    ///< Row<ContactRecord>
RowType warning_row_type();    ///< Row<WarningRecord>

// Rows that belong to a graph.
RowType division_row_type();    ///< Row<DivisionRecord>
RowType dependency_row_type();  ///< Row<DependencyRecord>

void write_devices(hid_t run_group, const std::vector<DeviceDescription>& devices);
std::vector<DeviceDescription> read_devices(hid_t run_group);

}  // namespace weft::trace
