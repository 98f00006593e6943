#include "runtime/trace/frame_rows.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace weft::trace {

namespace {

/// In the order of the file.
constexpr FrameColumn kFrames[] = {
    {"frame", &FrameRecord::frame},
    {"sim_time", &FrameRecord::sim_time, "s"},
    {"start", &FrameRecord::start, "s"},
    {"end", &FrameRecord::end, "s"},
    {"planned_makespan", &FrameRecord::planned_makespan, "s"},
    {"measured_makespan", &FrameRecord::measured_makespan, "s"},
    {"lower_bound", &FrameRecord::lower_bound, "s"},
    {"plan_time", &FrameRecord::plan_time, "s"},
    {"place_time", &FrameRecord::place_time, "s"},
    {"execute_time", &FrameRecord::execute_time, "s"},
    {"check_time", &FrameRecord::check_time, "s"},
    {"learn_time", &FrameRecord::learn_time, "s"},
    {"measure_time", &FrameRecord::measure_time, "s"},
    {"output_time", &FrameRecord::output_time, "s"},
    {"pace", &FrameRecord::pace},
    {"strain_rms", &FrameRecord::strain_rms},
    {"strain_max", &FrameRecord::strain_max},
    {"work", &FrameRecord::work, "J"},
    {"dissipated", &FrameRecord::dissipated, "J"},
    {"gained", &FrameRecord::gained, "J"},
    {"relative_error_estimate", &FrameRecord::relative_error},
    {"transferred_bytes", &FrameRecord::transferred_bytes, "B"},
    {"graph", GraphNumber{}},
    {"substeps", &FrameRecord::substeps},
    {"iterations", &FrameRecord::iterations},
    {"planner", ShortText{&FrameRecord::planner, 16}},
    {"state_hash", ShortText{&FrameRecord::state_hash, 32}},
};

constexpr FrameColumn kEnergies[] = {
    {"frame", &FrameRecord::frame},
    {"kinetic", &FrameRecord::kinetic_energy, "J"},
    {"gravity", &FrameRecord::gravity_energy, "J"},
};

/// Of a column in a row.
struct TypeOf {
    template <class Number>
    hdf5::Handle operator()(Number FrameRecord::* /*member*/) const {
        return {H5Tcopy(native_type<Number>()), H5Tclose, "create a table's row type"};
    }
    hdf5::Handle operator()(const ShortText& text) const { return short_text_type(text.size); }
    hdf5::Handle operator()(GraphNumber /*graph*/) const {
        return (*this)(&FrameRecord::frame);  // a number like any other
    }
};

/// Puts one column after the other behind what there is of a row.
struct Packer {
    const FrameRecord& record;
    std::vector<std::byte>& row;

    void add(const void* bytes, std::size_t count) const {
        const auto* begin = static_cast<const std::byte*>(bytes);
        row.insert(row.end(), begin, begin + count);
    }
    template <class Number>
    void operator()(Number FrameRecord::*member) const {
        add(&(record.*member), sizeof(Number));
    }
    void operator()(const ShortText& text) const {
        const std::string& all = record.*text.text;
        const std::size_t end = row.size() + text.size;
        add(all.data(), std::min(all.size(), text.size));
        row.resize(end);
    }
    void operator()(GraphNumber /*graph*/) const {
        const std::uint32_t number = record.graph ? record.graph->graph : kNoGraph;
        add(&number, sizeof(number));
    }
};

/// Takes one column after the other from a row.
struct Unpacker {
    const std::byte*& row;
    FrameRecord& record;

    void take(void* bytes, std::size_t count) const {
        std::copy_n(row, count, static_cast<std::byte*>(bytes));
        row += count;
    }
    template <class Number>
    void operator()(Number FrameRecord::*member) const {
        take(&(record.*member), sizeof(Number));
    }
    void operator()(const ShortText& text) const {
        std::string all(text.size, '\0');
        take(all.data(), all.size());
        record.*text.text = all.c_str();  // up to the first zero
    }
    void operator()(GraphNumber /*graph*/) const {
        GraphRecord graph;
        take(&graph.graph, sizeof(graph.graph));
        record.graph = graph.graph == kNoGraph ? nullptr : std::make_shared<GraphRecord>(graph);
    }
};

}  // namespace

FrameRows FrameRows::of_frames(std::size_t device_count) {
    std::vector<std::string> busy;
    for (std::size_t i = 0; i < device_count; ++i) busy.push_back("busy_" + std::to_string(i));
    return {kFrames, std::move(busy), "s"};
}

FrameRows FrameRows::of_energies(const std::vector<std::string>& energies) {
    std::vector<std::string> others = energies;
    others.emplace_back("total");
    return {kEnergies, std::move(others), "J"};
}

FrameRows::FrameRows(std::span<const FrameColumn> columns, std::vector<std::string> doubles,
                     const char* unit)
    : columns_(columns), doubles_(std::move(doubles)), unit_(unit) {}

RowType FrameRows::type() const {
    std::vector<hdf5::Handle> types;
    std::vector<RowType::Column> columns;
    std::size_t size = 0;
    const auto add = [&](const std::string& name, hdf5::Handle type, const char* unit) {
        columns.push_back({name, type.id(), size, unit});
        size += H5Tget_size(type.id());
        types.push_back(std::move(type));
    };
    for (const FrameColumn& c : columns_) add(c.name, std::visit(TypeOf{}, c.value), c.unit);
    for (const std::string& name : doubles_) add(name, TypeOf{}(&FrameRecord::start), unit_);
    return {size, columns};
}

std::vector<std::byte> FrameRows::pack(const FrameRecord& record,
                                       std::span<const double> doubles) const {
    std::vector<std::byte> row;
    const Packer packer{record, row};
    for (const FrameColumn& column : columns_) std::visit(packer, column.value);
    packer.add(doubles.data(), doubles.size_bytes());
    return row;
}

std::vector<double> FrameRows::unpack(const std::byte* row, FrameRecord& record) const {
    const Unpacker unpacker{row, record};
    for (const FrameColumn& column : columns_) std::visit(unpacker, column.value);
    std::vector<double> doubles(doubles_.size());
    unpacker.take(doubles.data(), doubles.size() * sizeof(double));
    return doubles;
}

}  // namespace weft::trace
