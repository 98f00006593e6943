#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "runtime/trace/records.h"
#include "runtime/trace/row_type.h"

/// The columns of a trace's tables: one definition for writer and reader; those of `frames` and
/// `energies` are in frame_rows.h. The library matches columns by name, so a reader of an older or
/// newer Weft finds those it knows.

namespace weft::trace {

inline constexpr const char* kFormatName = "weft-trace";
inline constexpr int kFormatVersion = 1;

/// What to doubt in a frame.
struct WarningRecord {
    std::array<char, 512> text{};  ///< filled up with zeros
};

/// How many strips a graph gives to a device.
struct DivisionRecord {
    std::uint32_t device = 0;
    std::uint32_t strips = 0;
};

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
