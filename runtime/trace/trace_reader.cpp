#include "runtime/trace/trace_reader.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "runtime/error.h"
#include "runtime/io/hdf5/attributes.h"
#include "runtime/io/hdf5/datasets.h"
#include "runtime/io/hdf5/files.h"
#include "runtime/trace/frame_rows.h"
#include "runtime/trace/tables.h"

namespace weft {

namespace {

using hdf5::Handle;
using trace::Row;
using trace::RowType;

struct RowRange {
    std::size_t first = 0;
    std::size_t count = 0;
};

/// Reads ranges of a table's rows; a table that the trace does not have is empty.
class TableReader {
public:
    TableReader(hid_t file, std::string name, RowType type)
        : name_(std::move(name)), type_(std::move(type)) {
        if (!hdf5::exists(file, name_)) return;
        data_ = Handle(H5Dopen2(file, name_.c_str(), H5P_DEFAULT), H5Dclose, what());
        const Handle space(H5Dget_space(data_.id()), H5Sclose, what());
        if (H5Sget_simple_extent_ndims(space.id()) != 1) throw hdf5::Error(what() + ": no table");
        rows_ = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.id()));
    }

    std::size_t rows() const { return rows_; }
    std::size_t row_size() const { return type_.size(); }

    std::vector<std::byte> read(RowRange range) const {
        return read_as(type_.memory(), type_.size(), range);
    }

    /// The rows that belong to a frame or graph; rows are in rising order of these.
    RowRange rows_of(std::uint32_t owner) const {
        if (!owners_) owners_ = read_owner_column();
        const auto [begin, end] = std::equal_range(owners_->begin(), owners_->end(), owner);
        return {static_cast<std::size_t>(begin - owners_->begin()),
                static_cast<std::size_t>(end - begin)};
    }

    template <class Record>
    std::vector<Record> records(std::uint32_t owner) const {
        const RowRange range = rows_of(owner);
        const std::vector<std::byte> bytes = read(range);
        std::vector<Record> records(range.count);
        for (std::size_t i = 0; i < range.count; ++i) {
            Row<Record> row;
            std::memcpy(&row, bytes.data() + i * sizeof(row), sizeof(row));
            records[i] = row.record;
        }
        return records;
    }

private:
    std::string what() const { return "read table '" + name_ + "'"; }

    std::vector<std::uint32_t> read_owner_column() const {
        const std::vector<std::byte> bytes =
            read_as(type_.owner_only(), sizeof(std::uint32_t), {0, rows_});
        std::vector<std::uint32_t> owners(rows_);
        std::ranges::copy(bytes, std::as_writable_bytes(std::span(owners)).begin());
        return owners;
    }

    /// Columns that the file lacks stay 0.
    std::vector<std::byte> read_as(hid_t memory_type, std::size_t row_size, RowRange range) const {
        std::vector<std::byte> bytes(range.count * row_size);
        if (range.count == 0) return bytes;
        const hsize_t start = range.first;
        const hsize_t count = range.count;
        const Handle file_space(H5Dget_space(data_.id()), H5Sclose, what());
        hdf5::check(
            H5Sselect_hyperslab(file_space.id(), H5S_SELECT_SET, &start, nullptr, &count, nullptr),
            what());
        const Handle memory_space(H5Screate_simple(1, &count, nullptr), H5Sclose, what());
        hdf5::check(H5Dread(data_.id(), memory_type, memory_space.id(), file_space.id(),
                            H5P_DEFAULT, bytes.data()),
                    what());
        return bytes;
    }

    std::string name_;
    RowType type_;
    Handle data_;
    std::size_t rows_ = 0;
    mutable std::optional<std::vector<std::uint32_t>> owners_;
};

/// Up to the first zero byte.
template <std::size_t Size>
std::string text_of(const std::array<char, Size>& bytes) {
    return {bytes.begin(), std::find(bytes.begin(), bytes.end(), '\0')};
}

TextPairs read_pairs(hid_t parent, const std::string& name) {
    TextPairs pairs;
    if (!hdf5::exists(parent, name)) return pairs;
    const Handle group(H5Gopen2(parent, name.c_str(), H5P_DEFAULT), H5Gclose, "open " + name);
    for (const std::string& key : hdf5::attribute_names(group.id())) {
        pairs.emplace_back(key, hdf5::read_text_attribute(group.id(), key));
    }
    return pairs;
}

struct Tables {
    Tables(hid_t file, const RunDescription& run)
        : energy_rows(trace::FrameRows::of_energies(run.energies)),
          frame_rows(trace::FrameRows::of_frames(run.devices.size())),
          plan(file, "plan", trace::plan_row_type()),
          divisions(file, "divisions", trace::division_row_type()),
          dependencies(file, "dependencies", trace::dependency_row_type()),
          executions(file, "executions", trace::execution_row_type()),
          costs(file, "costs", trace::cost_row_type()),
          links(file, "links", trace::link_row_type()),
          transfers(file, "transfers", trace::transfer_row_type()),
          contacts(file, "contacts", trace::contact_row_type()),
          warnings(file, "warnings", trace::warning_row_type()),
          energies(file, "energies", energy_rows.type()),
          frames(file, "frames", frame_rows.type()) {}

    trace::FrameRows energy_rows, frame_rows;
    TableReader plan;
    TableReader divisions;
    TableReader dependencies;
    TableReader executions;
    TableReader costs;
    TableReader links;
    TableReader transfers;
    TableReader contacts;
    TableReader warnings;
    TableReader energies;
    TableReader frames;
};

}  // namespace

class TraceReader::Impl {
public:
    explicit Impl(const std::filesystem::path& path) : path_(path.string()) {
        check_it_is_hdf5();
        guarded([&] {
            file_ = hdf5::open_to_read(path_);
            check_format();
            read_run();
            tables_.emplace(file_.id(), run_);
            read_frames();
            read_warnings();
            read_energies();
        });
    }

    FrameRecord frame(std::size_t index) const {
        FrameRecord record = frames_.at(index);
        guarded([&] {
            record.plan = tables_->plan.records<PlanRecord>(record.frame);
            record.executions = tables_->executions.records<ExecutionRecord>(record.frame);
            record.costs = tables_->costs.records<CostRecord>(record.frame);
            record.links = tables_->links.records<LinkRecord>(record.frame);
            record.transfers = tables_->transfers.records<TransferRecord>(record.frame);
            record.contacts = tables_->contacts.records<ContactRecord>(record.frame);
            record.graph = graph(graph_numbers_.at(index));
        });
        return record;
    }

    RunDescription run_;
    std::string started_;
    std::string state_hash_;
    bool finished_ = false;
    std::vector<FrameRecord> frames_;

private:
    /// Null if it is not in the trace.
    std::shared_ptr<const GraphRecord> graph(std::uint32_t number) const {
        if (const auto known = graphs_.find(number); known != graphs_.end()) return known->second;
        GraphRecord record{number, {}, tables_->dependencies.records<DependencyRecord>(number)};
        for (const auto& share : tables_->divisions.records<trace::DivisionRecord>(number)) {
            record.strips.push_back(share.strips);
        }
        auto& known = graphs_[number];
        if (!record.strips.empty()) known = std::make_shared<const GraphRecord>(std::move(record));
        return known;
    }

    void check_it_is_hdf5() const {
        if (!std::filesystem::exists(path_)) throw UserError(path_ + ": no such trace");
        if (std::filesystem::is_directory(path_)) {
            throw UserError(path_ + ": is a folder; a trace is a file, usually trace.h5 in it");
        }
        const hdf5::Session session;
        if (H5Fis_hdf5(path_.c_str()) <= 0) {
            throw UserError(path_ + ": not a trace: it is not an HDF5 file, or was cut off");
        }
    }

    void check_format() const {
        const hid_t file = file_.id();
        if (H5Aexists(file, "format") <= 0 ||
            hdf5::read_text_attribute(file, "format") != trace::kFormatName) {
            throw UserError(path_ +
                            ": not a trace of Weft: an HDF5 file, but its attribute"
                            " 'format' is not \"" +
                            trace::kFormatName + "\"");
        }
        const int version = hdf5::read_int_attribute(file, "format_version");
        if (version != trace::kFormatVersion) {
            throw UserError(path_ + ": trace format version " + std::to_string(version) +
                            "; this Weft reads version " + std::to_string(trace::kFormatVersion));
        }
    }

    void read_run() {
        finished_ = hdf5::read_bool_attribute(file_.id(), "finished");
        state_hash_ = hdf5::read_text_attribute(file_.id(), "state_hash");
        const Handle group(H5Gopen2(file_.id(), "run", H5P_DEFAULT), H5Gclose, "open group 'run'");
        started_ = hdf5::read_text_attribute(group.id(), "started");
        run_.scene_name = hdf5::read_text_attribute(group.id(), "scene_name");
        if (H5Aexists(group.id(), "scene_path") > 0) {
            run_.scene_path = hdf5::read_text_attribute(group.id(), "scene_path");
        }
        run_.command = hdf5::read_text_attribute(group.id(), "command");
        run_.scene_text = hdf5::read_text(group.id(), "scene");
        run_.kinds = hdf5::read_texts(group.id(), "kinds");
        run_.energies = hdf5::read_texts(group.id(), "energies");
        if (hdf5::exists(group.id(), "warnings")) {
            run_.warnings = hdf5::read_texts(group.id(), "warnings");
        }
        run_.devices = trace::read_devices(group.id());
        run_.host = read_pairs(group.id(), "host");
        run_.versions = read_pairs(group.id(), "versions");
        run_.settings = read_pairs(group.id(), "settings");
        run_.meshes = read_pairs(group.id(), "meshes");
        run_.has_transfers = hdf5::exists(file_.id(), "transfers");
        run_.has_contacts = hdf5::exists(file_.id(), "contacts");
    }

    void read_frames() {
        const TableReader& table = tables_->frames;
        const std::vector<std::byte> bytes = table.read({0, table.rows()});
        frames_.resize(table.rows());
        for (std::size_t i = 0; i < frames_.size(); ++i) {
            FrameRecord& frame = frames_[i];
            frame.busy = tables_->frame_rows.unpack(bytes.data() + i * table.row_size(), frame);
            if (!(frame.pace > 0.0)) frame.pace = 1.0;  // not known
            graph_numbers_.push_back(frame.graph ? frame.graph->graph : trace::kNoGraph);
            frame.graph.reset();
        }
    }

    void read_warnings() {
        for (FrameRecord& frame : frames_) {
            for (const auto& row : tables_->warnings.records<trace::WarningRecord>(frame.frame)) {
                frame.warnings.push_back(text_of(row.text));
            }
        }
    }

    /// One row per frame, in the same order.
    void read_energies() {
        const TableReader& table = tables_->energies;
        const std::size_t count = std::min(table.rows(), frames_.size());
        const std::vector<std::byte> bytes = table.read({0, count});
        for (std::size_t i = 0; i < count; ++i) {
            FrameRecord& frame = frames_[i];
            const std::uint32_t number = frame.frame;
            const std::byte* row = bytes.data() + i * table.row_size();
            frame.energies = tables_->energy_rows.unpack(row, frame);
            frame.energies.pop_back();  // the total, which follows from the others
            frame.frame = number;       // the table `frames` says it, whatever is beside it
        }
    }

    template <class Action>
    void guarded(Action action) const {
        const hdf5::Session session;
        try {
            action();
        } catch (const hdf5::Error& error) {
            throw UserError(path_ + ": cannot read the trace: " + error.what());
        }
    }

    const std::string path_;
    Handle file_;
    std::optional<Tables> tables_;
    std::vector<std::uint32_t> graph_numbers_;  // [frame]
    mutable std::map<std::uint32_t, std::shared_ptr<const GraphRecord>> graphs_;
};

TraceReader::TraceReader(const std::filesystem::path& path) : impl_(std::make_unique<Impl>(path)) {}

TraceReader::~TraceReader() = default;

const RunDescription& TraceReader::run() const { return impl_->run_; }
const std::string& TraceReader::started() const { return impl_->started_; }
bool TraceReader::finished() const { return impl_->finished_; }
const std::string& TraceReader::state_hash() const { return impl_->state_hash_; }
const std::vector<FrameRecord>& TraceReader::frames() const { return impl_->frames_; }
FrameRecord TraceReader::frame(std::size_t index) const { return impl_->frame(index); }

}  // namespace weft
