#include "runtime/trace/tables.h"

#include "runtime/io/hdf5/datasets.h"
#include "runtime/io/hdf5/types.h"

#include <cstddef>

namespace weft::trace {

namespace {

/// Column for a member of a record that stands `base` bytes into the row.
template <class Record, class Member>
RowType::Column column(const char* name, Member Record::*member, const char* unit = "",
                       std::size_t base = 0) {
    const Record record{};
    const auto* begin = reinterpret_cast<const std::byte*>(&record);
    const auto* field = reinterpret_cast<const std::byte*>(&(record.*member));
    return {name, native_type<Member>(), base + static_cast<std::size_t>(field - begin), unit};
}

/// Collects the columns of a Row<Record>, that of its owner first.
template <class Record>
class RowColumns {
public:
    explicit RowColumns(const char* owner = "frame")
        : columns_{column(owner, &Row<Record>::owner)} {}

    template <class Member>
    RowColumns& add(const char* name, Member Record::*member, const char* unit = "") {
        columns_.push_back(column(name, member, unit, offsetof(Row<Record>, record)));
        return *this;
    }
    RowType type() const { return {sizeof(Row<Record>), columns_}; }

private:
    std::vector<RowType::Column> columns_;
};

/// A device as HDF5 stores it: text by pointer.
struct DeviceRow {
    const char* name;
    const char* kind;
    const char* driver;
    std::uint32_t units;
    const char* memory;
    signed char exact;
    std::uint32_t team;
};

hdf5::Handle device_type(hid_t text, hid_t boolean) {
    return compound_type(sizeof(DeviceRow),
                         {{"name", text, offsetof(DeviceRow, name)},
                          {"kind", text, offsetof(DeviceRow, kind)},
                          {"driver", text, offsetof(DeviceRow, driver)},
                          {"units", H5T_NATIVE_UINT32, offsetof(DeviceRow, units)},
                          {"memory", text, offsetof(DeviceRow, memory)},
                          {"exact", boolean, offsetof(DeviceRow, exact)},
                          {"team", H5T_NATIVE_UINT32, offsetof(DeviceRow, team)}});
}

}  // namespace

RowType plan_row_type() {
    return RowColumns<PlanRecord>()
        .add("task", &PlanRecord::task)
        .add("kind", &PlanRecord::kind)
        .add("iteration", &PlanRecord::iteration)
        .add("first_strip", &PlanRecord::first_strip)
        .add("strip_count", &PlanRecord::strip_count)
        .add("device", &PlanRecord::device)
        .add("home", &PlanRecord::home)
        .add("order", &PlanRecord::order)
        .add("items", &PlanRecord::items)
        .add("start", &PlanRecord::start, "s")
        .add("end", &PlanRecord::end, "s")
        .type();
}

RowType execution_row_type() {
    return RowColumns<ExecutionRecord>()
        .add("substep", &ExecutionRecord::substep)
        .add("task", &ExecutionRecord::task)
        .add("device", &ExecutionRecord::device)
        .add("items", &ExecutionRecord::items)
        .add("start", &ExecutionRecord::start, "s")
        .add("end", &ExecutionRecord::end, "s")
        .type();
}

RowType cost_row_type() {
    return RowColumns<CostRecord>()
        .add("kind", &CostRecord::kind)
        .add("device", &CostRecord::device)
        .add("fixed", &CostRecord::fixed, "s")
        .add("per_item", &CostRecord::per_item, "s")
        .add("samples", &CostRecord::samples)
        .type();
}

RowType link_row_type() {
    return RowColumns<LinkRecord>()
        .add("from", &LinkRecord::from)
        .add("to", &LinkRecord::to)
        .add("latency", &LinkRecord::latency, "s")
        .add("bandwidth", &LinkRecord::bandwidth, "B/s")
        .type();
}

RowType division_row_type() {
    return RowColumns<DivisionRecord>("graph")
        .add("device", &DivisionRecord::device)
        .add("strips", &DivisionRecord::strips)
        .type();
}

RowType dependency_row_type() {
    return RowColumns<DependencyRecord>("graph")
        .add("from", &DependencyRecord::from)
        .add("to", &DependencyRecord::to)
        .add("carried", &DependencyRecord::carried)
        .add("bytes", &DependencyRecord::bytes, "B")
        .type();
}

RowType transfer_row_type() {
    return RowColumns<TransferRecord>()
        .add("substep", &TransferRecord::substep)
        .add("task", &TransferRecord::task)
        .add("from", &TransferRecord::from)
        .add("to", &TransferRecord::to)
        .add("bytes", &TransferRecord::bytes, "B")
        .add("start", &TransferRecord::start, "s")
        .add("end", &TransferRecord::end, "s")
        .type();
}

RowType contact_row_type() {
    return RowColumns<ContactRecord>()
        .add("pairs", &ContactRecord::pairs)
        .add("rows", &ContactRecord::rows)
        .add("touching", &ContactRecord::touching)
        .add("truncated", &ContactRecord::truncated)
        .add("lost", &ContactRecord::lost)
        .add("redone", &ContactRecord::redone)
        .add("substeps_wanted", &ContactRecord::substeps_wanted)
        .add("least_distance", &ContactRecord::least_distance, "m")
        .type();
}

RowType warning_row_type() {
    const hdf5::Handle text = short_text_type(sizeof(WarningRecord::text));
    return {sizeof(Row<WarningRecord>),
            {column("frame", &Row<WarningRecord>::owner),
             {"text", text.id(), offsetof(Row<WarningRecord>, record.text)}}};
}

void write_devices(hid_t run_group, const std::vector<DeviceDescription>& devices) {
    std::vector<DeviceRow> rows;
    for (const DeviceDescription& device : devices) {
        rows.push_back({device.name.c_str(), device.kind.c_str(), device.driver.c_str(),
                        device.units, device.memory.c_str(), static_cast<signed char>(device.exact),
                        device.team});
    }
    const hdf5::Handle text = hdf5::string_type();
    const hdf5::Handle boolean = hdf5::bool_type();
    const hdf5::Handle type = device_type(text.id(), boolean.id());
    const hsize_t shape[] = {rows.size()};
    hdf5::write_array(run_group, "devices", type.id(), shape, rows.data());
}

std::vector<DeviceDescription> read_devices(hid_t run_group) {
    constexpr const char* kWhat = "read dataset 'devices'";
    const hdf5::Handle dataset(H5Dopen2(run_group, "devices", H5P_DEFAULT), H5Dclose, kWhat);
    const hdf5::Handle space(H5Dget_space(dataset.id()), H5Sclose, kWhat);
    const hdf5::Handle text = hdf5::string_type();
    const hdf5::Handle boolean = hdf5::bool_type();
    const hdf5::Handle type = device_type(text.id(), boolean.id());
    std::vector<DeviceRow> rows(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.id())),
                                DeviceRow{});
    hdf5::check(H5Dread(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()),
                kWhat);
    std::vector<DeviceDescription> devices;
    const auto value = [](const char* string) { return std::string(string ? string : ""); };
    for (const DeviceRow& row : rows) {
        devices.push_back({value(row.name), value(row.kind), value(row.driver), row.units,
                           value(row.memory), row.exact != 0, row.team});
    }
    H5Dvlen_reclaim(type.id(), space.id(), H5P_DEFAULT, rows.data());
    return devices;
}

}  // namespace weft::trace
