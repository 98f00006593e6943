#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "runtime/error.h"
#include "runtime/io/hdf5/attributes.h"
#include "runtime/io/hdf5/files.h"
#include "runtime/trace/trace_reader.h"
#include "runtime/trace/trace_writer.h"
#include "tests/runtime/trace/synthetic_run.h"

namespace weft {
namespace {

class Trace : public testing::Test {
protected:
    void SetUp() override {
        folder_ = std::filesystem::path(testing::TempDir()) /
                  testing::UnitTest::GetInstance()->current_test_info()->name();
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path file(const std::string& name = "trace.h5") const {
        return folder_ / name;
    }

    void write(const synthetic::Shape& shape, std::uint32_t frames) const {
        TraceWriter writer(file(), synthetic::describe(shape));
        for (std::uint32_t i = 0; i < frames; ++i) writer.append(synthetic::frame(shape, i));
        writer.finish("0123abcd");
    }

    std::filesystem::path folder_;
};

template <class Error, class Action>
std::string message_of(Action action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return "no such error";
}

TEST_F(Trace, ReadsBackWhatWasWritten) {
    const synthetic::Shape shape;
    write(shape, 10);
    const TraceReader reader(file());

    EXPECT_TRUE(reader.finished());
    EXPECT_EQ(reader.state_hash(), "0123abcd");
    const RunDescription run = synthetic::describe(shape);
    EXPECT_EQ(reader.run().scene_text, run.scene_text);
    EXPECT_EQ(reader.run().command, run.command);
    EXPECT_EQ(reader.run().scene_path, run.scene_path);
    EXPECT_TRUE(reader.run().meshes.empty());
    EXPECT_EQ(reader.run().kinds, run.kinds);
    EXPECT_EQ(reader.run().energies, run.energies);
    EXPECT_EQ(reader.run().warnings, run.warnings);
    EXPECT_EQ(reader.run().settings, run.settings);
    EXPECT_EQ(TextPairs(reader.run().host.rbegin(), reader.run().host.rend()), run.host);
    ASSERT_EQ(reader.run().devices.size(), 2U);
    EXPECT_EQ(reader.run().devices[1].driver, "PoCL 3.1");
    EXPECT_EQ(reader.run().devices[1].units, 1U);
    EXPECT_TRUE(reader.run().devices[1].exact);

    ASSERT_EQ(reader.frames().size(), 10U);
    const FrameRecord expected = synthetic::frame(shape, 7);
    const FrameRecord frame = reader.frame(7);
    EXPECT_EQ(frame.frame, 7U);
    EXPECT_EQ(frame.sim_time, expected.sim_time);
    EXPECT_EQ(frame.end, expected.end);
    EXPECT_EQ(frame.planned_makespan, expected.planned_makespan);
    EXPECT_EQ(frame.pace, expected.pace);
    for (const FramePart& part : kFrameParts) {
        EXPECT_EQ(frame.*part.time, expected.*part.time) << part.name;
    }
    EXPECT_EQ(frame.transferred_bytes, expected.transferred_bytes);
    EXPECT_EQ(frame.busy, expected.busy);
    EXPECT_EQ(frame.gravity_energy, expected.gravity_energy);
    EXPECT_EQ(frame.work, expected.work);
    EXPECT_EQ(frame.dissipated, expected.dissipated);
    EXPECT_EQ(frame.gained, expected.gained);
    EXPECT_EQ(frame.strain_rms, expected.strain_rms);
    EXPECT_EQ(frame.strain_max, expected.strain_max);
    EXPECT_EQ(frame.iterations, expected.iterations);
    EXPECT_EQ(frame.relative_error, expected.relative_error);
    EXPECT_EQ(frame.substeps, expected.substeps);
    EXPECT_EQ(frame.energies, expected.energies);
    EXPECT_EQ(frame.warnings.size(), 2U);
    EXPECT_EQ(frame.warnings, expected.warnings);
    EXPECT_TRUE(reader.frame(6).warnings.empty());
    ASSERT_EQ(frame.plan.size(), expected.plan.size());
    EXPECT_EQ(frame.plan[20].first_strip, expected.plan[20].first_strip);
    EXPECT_EQ(frame.plan[20].items, expected.plan[20].items);
    EXPECT_EQ(frame.plan[20].end, expected.plan[20].end);
    EXPECT_EQ(frame.plan[20].home, expected.plan[20].home);
    EXPECT_EQ(frame.planner, "in-order");
    EXPECT_EQ(frame.state_hash, expected.state_hash);
    ASSERT_TRUE(frame.graph);
    EXPECT_EQ(frame.graph->graph, 7U % 3U);
    EXPECT_EQ(frame.graph->strips, expected.graph->strips);
    EXPECT_EQ(frame.graph->dependencies, expected.graph->dependencies);
    ASSERT_EQ(frame.links.size(), 2U);
    EXPECT_EQ(frame.links[1].from, 1U);
    EXPECT_EQ(frame.links[1].latency, expected.links[1].latency);
    EXPECT_EQ(frame.links[1].bandwidth, expected.links[1].bandwidth);
    ASSERT_EQ(frame.executions.size(), expected.executions.size());
    EXPECT_EQ(frame.executions.back().task, expected.executions.back().task);
    EXPECT_EQ(frame.executions.back().end, expected.executions.back().end);
    ASSERT_EQ(frame.costs.size(), expected.costs.size());
    EXPECT_EQ(frame.costs[3].per_item, expected.costs[3].per_item);
    ASSERT_EQ(frame.transfers.size(), expected.transfers.size());
    EXPECT_EQ(frame.transfers[5].start, expected.transfers[5].start);
    ASSERT_EQ(frame.contacts.size(), 1U);
    const ContactRecord& contact = frame.contacts.front();
    EXPECT_EQ(contact.pairs, 1007U);
    EXPECT_EQ(contact.rows, 3007U);
    EXPECT_EQ(contact.touching, 57U);
    EXPECT_EQ(contact.truncated, 17U);
    EXPECT_EQ(contact.lost, 7U);
    EXPECT_EQ(contact.redone, 1U);
    EXPECT_EQ(contact.substeps_wanted, 27U);
    EXPECT_EQ(contact.least_distance, 1e-3 * 7);
}

TEST_F(Trace, FramesOfOneDivisionShareTheirGraph) {
    write({}, 9);
    const TraceReader reader(file());
    EXPECT_EQ(reader.frame(1).graph, reader.frame(4).graph);
    EXPECT_NE(reader.frame(1).graph, reader.frame(2).graph);
    std::size_t rows = 0;  // as often as there are divisions, not frames
    for (std::uint32_t i = 0; i < 3; ++i)
        rows += synthetic::frame({}, i).graph->dependencies.size();
    const hdf5::Session session;
    const hdf5::Handle opened = hdf5::open_to_read(file().string());
    const hdf5::Handle table(H5Dopen2(opened.id(), "dependencies", H5P_DEFAULT), H5Dclose, "");
    const hdf5::Handle space(H5Dget_space(table.id()), H5Sclose, "");
    EXPECT_EQ(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.id())), rows);
}

TEST_F(Trace, FrameWithoutAGraphIsReadable) {
    {
        TraceWriter writer(file(), synthetic::describe({}));
        FrameRecord record = synthetic::frame({}, 0);
        record.graph = nullptr;
        record.state_hash.clear();
        writer.append(std::move(record));
        writer.append(synthetic::frame({}, 1));
    }
    const TraceReader reader(file());
    EXPECT_FALSE(reader.frame(0).graph);
    EXPECT_EQ(reader.frame(0).state_hash, "");
    EXPECT_TRUE(reader.frame(1).graph);
}

TEST_F(Trace, HasNoTransfersTableWhereDevicesShareMemory) {
    write({.transfers = false}, 2);
    const TraceReader reader(file());
    EXPECT_FALSE(reader.run().has_transfers);
    const hdf5::Session session;
    const hdf5::Handle opened = hdf5::open_to_read(file().string());
    EXPECT_FALSE(hdf5::exists(opened.id(), "transfers"));
    EXPECT_TRUE(hdf5::exists(opened.id(), "executions"));
}

TEST_F(Trace, HasNoContactsTableWhereNothingTouches) {
    write({.contacts = false}, 2);
    const TraceReader reader(file());
    EXPECT_FALSE(reader.run().has_contacts);
    EXPECT_TRUE(reader.frame(1).contacts.empty());
    const hdf5::Session session;
    const hdf5::Handle opened = hdf5::open_to_read(file().string());
    EXPECT_FALSE(hdf5::exists(opened.id(), "contacts"));
}

TEST_F(Trace, WithoutFinishIsUnfinishedButComplete) {
    {
        TraceWriter writer(file(), synthetic::describe({}));
        for (std::uint32_t i = 0; i < 5; ++i) writer.append(synthetic::frame({}, i));
    }
    const TraceReader reader(file());
    EXPECT_FALSE(reader.finished());
    EXPECT_EQ(reader.state_hash(), "");
    EXPECT_EQ(reader.frames().size(), 5U);
}

TEST_F(Trace, RunWithoutFramesIsReadable) {
    write({}, 0);
    EXPECT_TRUE(TraceReader(file()).frames().empty());
}

TEST_F(Trace, ReplacesAnOldFileThatSomebodyIsReading) {
    write({}, 3);
    const TraceReader old(file());
    write({}, 5);
    EXPECT_EQ(old.frame(2).plan.size(), synthetic::frame({}, 2).plan.size());
    EXPECT_EQ(TraceReader(file()).frames().size(), 5U);
}

TEST_F(Trace, RefusesARecordThatDoesNotFit) {
    TraceWriter writer(file(), synthetic::describe({}));
    FrameRecord record = synthetic::frame({}, 0);
    record.busy.pop_back();
    EXPECT_THROW(writer.append(record), std::invalid_argument);
}

TEST_F(Trace, ReaderNamesWhatIsWrongWithAFile) {
    EXPECT_EQ(message_of<UserError>([&] { TraceReader reader(file()); }),
              file().string() + ": no such trace");
    EXPECT_EQ(message_of<UserError>([&] { TraceReader reader(folder_); }),
              folder_.string() + ": is a folder; a trace is a file, usually trace.h5 in it");
    std::ofstream(file()) << "[scene]\n";
    EXPECT_EQ(message_of<UserError>([&] { TraceReader reader(file()); }),
              file().string() + ": not a trace: it is not an HDF5 file, or was cut off");
    {
        const hdf5::Session session;
        const auto created = hdf5::create_file(file().string(), hdf5::FileFormat::kPlain);
        hdf5::publish(file().string());
    }
    EXPECT_EQ(message_of<UserError>([&] { TraceReader reader(file()); }),
              file().string() +
                  ": not a trace of Weft: an HDF5 file, but its attribute 'format'"
                  " is not \"weft-trace\"");
}

TEST_F(Trace, ReaderRefusesAnotherFormatVersion) {
    write({}, 1);
    {
        const hdf5::Session session;
        const hdf5::Handle opened = hdf5::open_to_modify(file().string());
        const int version[] = {99};
        hdf5::write_int_attribute(opened.id(), "format_version", version);
    }
    EXPECT_EQ(message_of<UserError>([&] { TraceReader reader(file()); }),
              file().string() + ": trace format version 99; this Weft reads version 1");
}

TEST_F(Trace, UnwritablePlacesAreRunErrors) {
    const RunDescription run = synthetic::describe({});
    const auto missing = folder_ / "missing" / "trace.h5";
    EXPECT_EQ(message_of<RunError>([&] { TraceWriter writer(missing, run); }),
              missing.string() + ": cannot write the trace: create: No such file or directory");
    EXPECT_EQ(message_of<RunError>([&] { TraceWriter writer(folder_, run); }),
              folder_.string() +
                  ": cannot write the trace: create: there is something of that name"
                  " that is not a file");
}

/// A limit on the size of files stands for a full disk: both fail the same system call.
class FullDisk : public Trace {
protected:
    void limit(rlim_t bytes) {
        getrlimit(RLIMIT_FSIZE, &before_);
        rlimit now = before_;
        now.rlim_cur = bytes;
        std::signal(SIGXFSZ, SIG_IGN);
        setrlimit(RLIMIT_FSIZE, &now);
    }
    void lift() { setrlimit(RLIMIT_FSIZE, &before_); }
    void TearDown() override {
        lift();
        Trace::TearDown();
    }

    rlimit before_{};
};

TEST_F(FullDisk, EndsWithAMessageAndKeepsTheFramesBefore) {
    std::uint32_t appended = 0;
    std::string message;
    {
        TraceWriter writer(file(), synthetic::describe({}));
        limit(1 << 20);
        message = message_of<RunError>([&] {
            for (; appended < 2000; ++appended) writer.append(synthetic::frame({}, appended));
            writer.finish("");
        });
        EXPECT_THROW(writer.finish(""), RunError);  // and it stays failed
    }
    lift();
    EXPECT_NE(message.find("cannot write the trace: "), std::string::npos) << message;
    EXPECT_NE(message.find("File too large"), std::string::npos) << message;

    // A copy, since HDF5 would show this process what it holds in memory of the file itself.
    std::filesystem::copy_file(file(), file("copy.h5"));
    const TraceReader reader(file("copy.h5"));
    EXPECT_FALSE(reader.finished());
    ASSERT_GT(reader.frames().size(), 10U);
    EXPECT_GE(reader.frames().size(), appended - 1);
    const std::size_t last = reader.frames().size() - 1;
    EXPECT_EQ(reader.frame(last).executions.size(),
              synthetic::frame({}, static_cast<std::uint32_t>(last)).executions.size());
}

}  // namespace
}  // namespace weft
