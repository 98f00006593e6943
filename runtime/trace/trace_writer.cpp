#include "runtime/trace/trace_writer.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>

#include "runtime/error.h"
#include "runtime/io/background_writer.h"
#include "runtime/io/hdf5/attributes.h"
#include "runtime/io/hdf5/datasets.h"
#include "runtime/io/hdf5/files.h"
#include "runtime/io/hdf5/growing_dataset.h"
#include "runtime/trace/frame_rows.h"
#include "runtime/trace/tables.h"

namespace weft {

namespace {

using hdf5::GrowingDataset;
using hdf5::Handle;
using trace::Row;
using trace::RowType;

/// A table and the rows of the frame at hand. Chunks of compressed tables hold about one frame of
/// a middling scene: each flush writes the last chunk anew, in new space, since its size changes.
class Table {
public:
    Table(hid_t file, const std::string& name, RowType type, hsize_t chunk_rows, unsigned deflate)
        : type_(std::move(type)), data_(file, name, type_.file(), {}, chunk_rows, deflate) {
        hdf5::write_texts_attribute(data_.id(), "units", type_.units());
    }

    template <class Record>
    void append(std::uint32_t owner, const std::vector<Record>& records) {
        if (records.empty()) return;
        std::vector<Row<Record>> rows;
        rows.reserve(records.size());
        for (const Record& record : records) rows.push_back({owner, record});
        data_.append(type_.memory(), rows.data(), rows.size());
        data_.flush();
    }

    /// One row, as FrameRows packs it.
    void append(const std::vector<std::byte>& row) {
        data_.append(type_.memory(), row.data(), 1);
        data_.flush();
    }

    void close() { data_.close(); }
    void abandon() { data_.abandon(); }

private:
    RowType type_;
    GrowingDataset data_;
};

/// Cut where it is too long.
template <std::size_t Size>
void fill(std::array<char, Size>& column, const std::string& text) {
    std::copy_n(text.begin(), std::min(text.size(), Size), column.begin());
}

constexpr unsigned kDeflate = 1;  // higher levels cost far more time and save little
constexpr hsize_t kManyRows = 512;
constexpr hsize_t kFewRows = 64;

struct Tables {
    Tables(hid_t file, const RunDescription& run)
        : energy_rows(trace::FrameRows::of_energies(run.energies)),
          frame_rows(trace::FrameRows::of_frames(run.devices.size())),
          plan(file, "plan", trace::plan_row_type(), kManyRows, kDeflate),
          divisions(file, "divisions", trace::division_row_type(), kFewRows, 0),
          dependencies(file, "dependencies", trace::dependency_row_type(), kManyRows, kDeflate),
          executions(file, "executions", trace::execution_row_type(), kManyRows, kDeflate),
          costs(file, "costs", trace::cost_row_type(), kFewRows, 0),
          warnings(file, "warnings", trace::warning_row_type(), kFewRows, 0),
          energies(file, "energies", energy_rows.type(), kFewRows, 0),
          frames(file, "frames", frame_rows.type(), kFewRows, 0) {
        if (run.devices.size() > 1) {
            links.emplace(file, "links", trace::link_row_type(), kFewRows, 0);
        }
        if (run.has_transfers) {
            transfers.emplace(file, "transfers", trace::transfer_row_type(), kManyRows, kDeflate);
        }
        if (run.has_contacts) {
            contacts.emplace(file, "contacts", trace::contact_row_type(), kFewRows, 0);
        }
    }

    /// The row of `frames` comes last: a frame that has one is complete.
    void append(const FrameRecord& record) {
        if (record.graph) append_graph(*record.graph);
        plan.append(record.frame, record.plan);
        executions.append(record.frame, record.executions);
        costs.append(record.frame, record.costs);
        if (links) links->append(record.frame, record.links);
        if (transfers) transfers->append(record.frame, record.transfers);
        if (contacts) contacts->append(record.frame, record.contacts);
        append_warnings(record);
        append_energies(record);
        frames.append(frame_rows.pack(record, record.busy));
    }

    /// Once, with the first frame that uses it.
    void append_graph(const GraphRecord& record) {
        if (!graphs_.insert(record.graph).second) return;
        std::vector<trace::DivisionRecord> shares;
        for (const std::uint32_t strips : record.strips) {
            shares.push_back({static_cast<std::uint32_t>(shares.size()), strips});
        }
        divisions.append(record.graph, shares);
        dependencies.append(record.graph, record.dependencies);
    }

    void append_warnings(const FrameRecord& record) {
        std::vector<trace::WarningRecord> rows;
        for (const std::string& warning : record.warnings) fill(rows.emplace_back().text, warning);
        warnings.append(record.frame, rows);
    }

    void append_energies(const FrameRecord& record) {
        std::vector<double> values = record.energies;
        values.push_back(std::accumulate(values.begin(), values.end(),
                                         record.kinetic_energy + record.gravity_energy));
        energies.append(energy_rows.pack(record, values));
    }

    void close() {
        for_each([](Table& table) { table.close(); });
    }
    void abandon() {
        for_each([](Table& table) { table.abandon(); });
    }

    template <class Action>
    void for_each(Action action) {
        for (Table* table : {&plan, &divisions, &dependencies, &executions, &costs, &warnings,
                             &energies, &frames}) {
            action(*table);
        }
        if (links) action(*links);
        if (transfers) action(*transfers);
        if (contacts) action(*contacts);
    }

    trace::FrameRows energy_rows, frame_rows;
    Table plan;
    Table divisions;
    Table dependencies;
    Table executions;
    Table costs;
    Table warnings;
    Table energies;
    Table frames;
    std::optional<Table> links;
    std::optional<Table> transfers;
    std::optional<Table> contacts;

private:
    std::set<std::uint32_t> graphs_;  // that are written
};

std::string now_utc() {
    const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    std::tm parts{};
    gmtime_r(&now, &parts);
    char text[sizeof("2000-01-01T00:00:00Z")];
    std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text;
}

void write_pairs(hid_t parent, const std::string& name, const TextPairs& pairs) {
    const Handle group = hdf5::create_group(parent, name);
    for (const auto& [key, value] : pairs) hdf5::write_text_attribute(group.id(), key, value);
}

void write_run(hid_t file, const RunDescription& run) {
    const int version[] = {trace::kFormatVersion};
    hdf5::write_text_attribute(file, "format", trace::kFormatName);
    hdf5::write_int_attribute(file, "format_version", version);
    hdf5::write_bool_attribute(file, "finished", false);
    hdf5::write_text_attribute(file, "state_hash", "");

    const Handle group = hdf5::create_group(file, "run");
    hdf5::write_text_attribute(group.id(), "scene_name", run.scene_name);
    hdf5::write_text_attribute(group.id(), "scene_path", run.scene_path);
    hdf5::write_text_attribute(group.id(), "command", run.command);
    hdf5::write_text_attribute(group.id(), "started", now_utc());
    hdf5::write_text(group.id(), "scene", run.scene_text);
    hdf5::write_texts(group.id(), "kinds", run.kinds);
    hdf5::write_texts(group.id(), "energies", run.energies);
    hdf5::write_texts(group.id(), "warnings", run.warnings);
    trace::write_devices(group.id(), run.devices);
    write_pairs(group.id(), "host", run.host);
    write_pairs(group.id(), "versions", run.versions);
    write_pairs(group.id(), "settings", run.settings);
    if (!run.meshes.empty()) write_pairs(group.id(), "meshes", run.meshes);
}

}  // namespace

class TraceWriter::Impl {
public:
    Impl(const std::filesystem::path& path, const RunDescription& run)
        : path_(path.string()),
          device_count_(run.devices.size()),
          energy_count_(run.energies.size()) {
        guarded([&] { create(run); });
        background_.emplace([this](Item& item) { write(item); });
    }

    void append(FrameRecord record, std::function<void(FrameRecord&)> complete) {
        if (!complete) check(record);
        background_->push({std::move(record), std::move(complete)});
    }

    void settle() { background_->drain(); }

    void finish(const std::string& state_hash) {
        background_->drain();
        guarded([&] {
            tables_->close();
            tables_.reset();
            file_.close("close");
            file_ = hdf5::open_to_modify(path_);  // text cannot be rewritten while readers follow
            hdf5::write_text_attribute(file_.id(), "state_hash", state_hash);
            hdf5::write_bool_attribute(file_.id(), "finished", true);
            file_.close("close");
        });
    }

private:
    struct Item {
        FrameRecord record;
        std::function<void(FrameRecord&)> complete;
    };

    void check(const FrameRecord& record) const {
        if (record.busy.size() == device_count_ && record.energies.size() == energy_count_) return;
        throw std::invalid_argument("a frame's record does not fit the run's description");
    }

    void write(Item& item) {
        if (item.complete) item.complete(item.record);
        check(item.record);
        guarded([&] { tables_->append(item.record); });
    }

    void create(const RunDescription& run) {
        file_ = hdf5::create_file(path_, hdf5::FileFormat::kSwmr);
        write_run(file_.id(), run);
        tables_.emplace(file_.id(), run);
        hdf5::check(H5Fflush(file_.id(), H5F_SCOPE_GLOBAL), "write");
        hdf5::check(H5Fstart_swmr_write(file_.id()), "let readers follow");
        hdf5::publish(path_);
    }

    template <class Action>
    void guarded(Action action) {
        const hdf5::Session session;
        try {
            action();
        } catch (const hdf5::Error& error) {
            if (tables_) tables_->abandon();
            file_.abandon();
            throw RunError(path_ + ": cannot write the trace: " + error.what());
        }
    }

    const std::string path_;
    const std::size_t device_count_;
    const std::size_t energy_count_;
    hdf5::Handle file_;
    std::optional<Tables> tables_;
    std::optional<BackgroundWriter<Item>> background_;
};

TraceWriter::TraceWriter(const std::filesystem::path& path, const RunDescription& run)
    : impl_(std::make_unique<Impl>(path, run)) {}

TraceWriter::~TraceWriter() = default;

void TraceWriter::append(FrameRecord record, std::function<void(FrameRecord&)> complete) {
    impl_->append(std::move(record), std::move(complete));
}

void TraceWriter::settle() { impl_->settle(); }

void TraceWriter::finish(const std::string& state_hash) { impl_->finish(state_hash); }

}  // namespace weft
