// What devices find is what brute force finds, as a set and in order; and has the same bits on
// every device, by every division, and whatever room the tables begin with.

#include "simulation/contact/pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "runtime/executor.h"
#include "runtime/opencl/opencl_device.h"
#include "runtime/tbb/cpu_device.h"
#include "tests/simulation/contact/pair_oracle.h"
#include "tests/simulation/run/manual_run.h"

namespace weft::test {
namespace {

constexpr int kPlenty = 200;

using Devices = std::vector<std::unique_ptr<Device>>;
using Rows = std::vector<std::vector<int>>;

Devices cpus(int count, int lanes = 0) {
    Devices devices;
    for (int d = 0; d < count; ++d) devices.push_back(make_cpu_device(1, {}, lanes));
    return devices;
}

void add_opencl(Devices& devices, MemoryModel memory, int lanes, EntryStyle style) {
    DeviceOptions options;
    options.memory = memory;
    options.opencl_lanes = lanes;
    options.entry_style = style;
    options.group_size = 16;
    for (auto& device : open_opencl_device(0, {}, options)) devices.push_back(std::move(device));
}

struct Found {
    Rows vt, tv, ee;
    friend bool operator==(const Found&, const Found&) = default;
};

/// One surface, found on some devices.
class Detection {
public:
    Detection(const ContactMesh& mesh, Devices devices, int room)
        : anchors_("anchors", mesh.anchors.size()),
          strides_("strides", mesh.anchors.size()),
          strip_begin_("strips", mesh.strips.begin.size()),
          strips_{&strip_begin_, 0, 1, mesh.strips.count()},
          devices_(std::move(devices)) {
        std::ranges::copy(mesh.anchors, anchors_.data());
        std::ranges::copy(mesh.strips.begin, strip_begin_.data());
        const PairSettings settings{mesh.thickness, 0.1f * mesh.thickness, mesh.self, room};
        pairs = std::make_unique<ContactPairs>(make_surface(mesh.mesh, mesh.strips), mesh.mesh.rest,
                                               anchors_, anchors_, strides_, strips_, settings, 0);
        std::vector<Device*> pointers;
        for (const auto& device : devices_) pointers.push_back(device.get());
        executor_ = std::make_unique<Executor>(pointers, pairs->bodies());
    }

    /// Two substeps, or so many, again until there is room.
    Found find(const Division& division, int substeps = 2) {
        for (int round = 0; round < 9; ++round) {
            const Step step = make_step(division.partition());
            executor_->run(step, plan_in_order(step, division), substeps);
            if (!make_room())
                return {rows_of(pairs->vt()), rows_of(pairs->tv()), rows_of(pairs->ee())};
            ++redone;
        }
        ADD_FAILURE() << "there is never enough room";
        return {};
    }
    Found find(int substeps = 2) {
        return find(
            Division::proportional(strips_.strip_count, std::vector<double>(devices_.size(), 1.0)),
            substeps);
    }
    void forget() { executor_->host_wrote(pairs->candidates().forget()); }
    Rows near() { return rows_of(pairs->near()); }
    /// Where everything is next.
    void move_to(std::span<const float4> anchors) {
        for (std::size_t v = 0; v < anchors.size(); ++v) {
            const float4& to = anchors[v];
            float4& from = anchors_[v];
            strides_[v] = {to.x - from.x, to.y - from.y, to.z - from.z, to.w - from.w};
            from = to;
        }
        executor_->host_wrote(anchors_);
        executor_->host_wrote(strides_);
    }
    /// Patches that have others near to them, and of these those that collected anew.
    std::pair<int, int> collected() {
        executor_->fetch(pairs->near().table.counts());
        executor_->fetch(pairs->candidates().stale());
        std::pair<int, int> sums;
        for (std::size_t p = 0; p < pairs->near().table.counts().count(); ++p) {
            if (pairs->near().table.counts()[p] == 0) continue;
            ++sums.first;
            sums.second += pairs->candidates().stale()[p];
        }
        return sums;
    }
    int strip_count() const { return strips_.strip_count; }

    std::unique_ptr<ContactPairs> pairs;
    int redone = 0;

private:
    Step make_step(const Partition& partition) {
        Step step;
        const auto for_each = [&](auto add) {
            int r = 0;
            for (const auto& part : partition.parts) add(part, RegionId{r++});
        };
        for_each([&](const auto& part, RegionId r) { pairs->add_boxes(step, part, r); });
        for_each([&](const auto& part, RegionId r) { pairs->add_near(step, part, r); });
        for_each([&](const auto& part, RegionId r) { pairs->add_pairs(step, part, r); });
        step.seal();
        return step;
    }

    bool make_room() {
        bool grew = false;
        for (RowTable* table : pairs->tables()) {
            executor_->fetch(table->needs());
            if (!table->overflowed()) continue;
            table->grow();
            executor_->rebind(table->resized_buffers());
            for (BufferStorage* buffer : table->written_buffers()) executor_->host_wrote(*buffer);
            grew = true;
        }
        return grew;
    }

    Rows rows_of(ContactPairs::Table& t) {
        executor_->fetch(t.table.counts());
        executor_->fetch(t.others);
        Rows rows;
        for (int i = 0; i < t.table.item_count(); ++i) {
            const auto item = static_cast<std::size_t>(i);
            std::vector<int> row;
            for (int k = 0; k < t.table.counts()[item]; ++k) {
                row.push_back(t.others[static_cast<std::size_t>(t.table.rows()[item] +
                                                                RowTable::kStride * k)]);
            }
            rows.push_back(std::move(row));
        }
        return rows;
    }

    Buffer<float4> anchors_, strides_;
    Buffer<int> strip_begin_;
    Segments strips_;
    Devices devices_;
    std::unique_ptr<Executor> executor_;
};

/// Both tables hold the same pairs.
Rows transposed(const Rows& rows, std::size_t count) {
    Rows others(count);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (const int entry : rows[i]) {
            others[static_cast<std::size_t>(entry / 2)].push_back(2 * static_cast<int>(i) +
                                                                  entry % 2);
        }
    }
    return others;
}

class ContactPairsOf : public testing::TestWithParam<std::size_t> {
protected:
    const ContactMesh mesh_ = contact_meshes()[GetParam()];
};

/// What a row has and what it should have; true: there are pairs to be sure of.
template <class Judge>
int expect_row(const std::vector<int>& row, int count, const std::string& what, Judge judge) {
    EXPECT_TRUE(std::ranges::is_sorted(row)) << what;
    int sure = 0;
    for (int other = 0; other < count; ++other) {
        const bool found = std::ranges::find(row, 2 * other) != row.end();
        const bool pushing = std::ranges::find(row, 2 * other + 1) != row.end();
        EXPECT_FALSE(found && pushing) << what << " twice with " << other;
        const Verdict verdict = judge(other);
        if (verdict == Verdict::kEither) continue;
        EXPECT_EQ(found, verdict == Verdict::kPair) << what << " with " << other;
        EXPECT_EQ(pushing, verdict == Verdict::kPushing) << what << " with " << other;
        sure += verdict != Verdict::kNone;
    }
    return sure;
}

TEST_P(ContactPairsOf, AreWhatBruteForceFinds) {
    Detection run(mesh_, cpus(1), kPlenty);
    const Found found = run.find();
    const Surface& s = run.pairs->surface();
    const PairOracle oracle(mesh_, s, run.pairs->settings());
    int sure = 0;
    for (int v = 0; v < s.vertex_count(); ++v) {
        sure += expect_row(found.vt[static_cast<std::size_t>(v)], s.triangle_count(),
                           "vertex " + std::to_string(v),
                           [&](int t) { return oracle.vertex_triangle(v, t); });
    }
    for (int e = 0; e < s.edge_count(); ++e) {
        sure +=
            expect_row(found.ee[static_cast<std::size_t>(e)], s.edge_count(),
                       "edge " + std::to_string(e), [&](int f) { return oracle.edge_edge(e, f); });
    }
    EXPECT_EQ(found.tv, transposed(found.vt, s.triangles.size()));
    EXPECT_EQ(found.ee, transposed(found.ee, s.edges.size()));
    RecordProperty("sure_pairs", sure);
    if (mesh_.name == "large folded") {
        EXPECT_GT(oracle.flat_groups(), 2);
    }
    if (mesh_.name == "flat") {
        for (const auto& row : run.near()) EXPECT_TRUE(row.empty());
    } else if (mesh_.name != "in one place" && mesh_.name != "aligned") {
        EXPECT_GT(sure, 50);
    }
}

/// Parallel edges above each other, and vertices above vertices: each of these pushes once.
TEST(ContactPairs, OfSheetsExactlyAboveEachOtherPushVertexByVertex) {
    const ContactMesh mesh = contact_meshes()[1];
    ASSERT_EQ(mesh.name, "aligned");
    const Found found = Detection(mesh, cpus(1), kPlenty).find();
    const auto pushing = [](const Rows& rows) {
        std::ptrdiff_t count = 0;
        for (const auto& row : rows) {
            count += std::ranges::count_if(row, [](int entry) { return entry % 2 == 1; });
        }
        return count;
    };
    EXPECT_EQ(2 * pushing(found.vt), std::ssize(mesh.mesh.rest));
    EXPECT_EQ(pushing(found.ee), 0);
}

TEST_P(ContactPairsOf, AreTheSameByEveryCutOnEveryCpu) {
    const Found expected = Detection(mesh_, cpus(1), kPlenty).find();
    for (const int lanes : {1, 8, 16}) {
        Detection run(mesh_, cpus(2, lanes), 8);
        for (int cut = 0; cut <= run.strip_count(); ++cut) {
            EXPECT_EQ(run.find({{cut, run.strip_count() - cut}}), expected)
                << lanes << " lanes, cut before strip " << cut;
        }
    }
}

TEST_P(ContactPairsOf, AreTheSameWithEveryRoom) {
    Detection plenty(mesh_, cpus(1), kPlenty);
    const Found expected = plenty.find();
    for (const int room : {0, 1, 2, 3, 5, 8, 13, 21}) {
        Detection run(mesh_, cpus(1), room);
        EXPECT_EQ(run.find(), expected) << room;
        if (room == 0 && mesh_.name != "flat") {
            EXPECT_GT(run.redone, 0);
        }
    }
}

/// Bodies that drift, turn and tremble by about `speed` thicknesses per step, and may get farther
/// or less far; some come back from there, so that others are near that were before.
class Motion {
public:
    Motion(const ContactMesh& mesh, float speed, int steps_to_turn)
        : mesh_(mesh),
          by_(speed * mesh.thickness),
          steps_to_turn_(steps_to_turn),
          anchors_(mesh.anchors) {}

    std::span<const float4> next() {
        if (++step_ % steps_to_turn_ == 0) by_ = -by_;
        for (std::size_t v = 0; v < anchors_.size(); ++v) {
            const float4 shake = random_.point(0.3f * std::abs(by_));
            const float4& start = mesh_.anchors[v];
            const bool is_upper = start.y > 0.1f;
            float4& x = anchors_[v];
            x.x += shake.x + (is_upper ? by_ : -by_) * (1.0f + 0.1f * start.z);
            x.y += shake.y - (is_upper ? 0.2f * by_ : 0.0f);
            x.z += shake.z + 0.1f * by_ * start.x;
            x.w = std::max(start.w, x.w + random_.real(-0.2f, 0.25f) * std::abs(by_));
        }
        return anchors_;
    }
    ContactMesh now() const {
        ContactMesh mesh = mesh_;
        mesh.anchors = anchors_;
        return mesh;
    }

private:
    const ContactMesh& mesh_;
    float by_;
    int steps_to_turn_;
    int step_ = 0;
    Random random_{7};
    std::vector<float4> anchors_;
};

struct Pace {
    float speed;
    int steps_to_turn;
};

constexpr int kNever = 1000;
constexpr Pace kPaces[] = {{0.0f, kNever}, {1e-3f, kNever}, {0.02f, kNever}, {0.1f, kNever},
                           {1.0f, kNever}, {0.1f, 7},       {0.4f, 7}};

/// What has been kept since earlier substeps saves work, and changes nothing: also where other
/// devices go on with it.
TEST_P(ContactPairsOf, AreTheSameFromCandidatesThatWereKept) {
    for (const auto& [speed, steps_to_turn] : kPaces) {
        Motion motion(mesh_, speed, steps_to_turn);
        Detection run(mesh_, cpus(2), 8);
        std::pair<int, int> late;
        for (int step = 0; step < 24; ++step) {
            run.move_to(motion.next());
            const int cut = (5 * step) % (run.strip_count() + 1);
            const Found found = run.find({{cut, run.strip_count() - cut}});
            ASSERT_EQ(found, Detection(motion.now(), cpus(1), kPlenty).find())
                << "step " << step << ", " << speed << " thicknesses per step";
            if (step < 4) continue;
            const auto [near, anew] = run.collected();
            late = {late.first + near, late.second + anew};
        }
        RecordProperty("collected_at_" + std::to_string(speed), late.second);
        if (speed < 0.01f) {
            EXPECT_LE(5 * late.second, late.first) << speed;
        }
        if (speed == 1.0f) {
            EXPECT_GE(2 * late.second, late.first);
        }
    }
}

TEST_P(ContactPairsOf, AreCollectedAnewWhereAsked) {
    Detection run(mesh_, cpus(1), kPlenty);
    const Found expected = run.find();
    const auto [near, nothing] = run.collected();
    EXPECT_EQ(nothing, 0);
    run.forget();
    EXPECT_EQ(run.find(1), expected);
    EXPECT_EQ(run.collected(), std::pair(near, near));
}

TEST_P(ContactPairsOf, AreKeptByDiscreteDevicesAsWell) {
    if (opencl_devices().empty()) GTEST_SKIP() << "no OpenCL device here";
    Motion motion(mesh_, 0.05f, kNever);
    Devices devices = cpus(1);
    add_opencl(devices, MemoryModel::kDiscrete, 8, EntryStyle::kPerStrip);
    Detection run(mesh_, std::move(devices), 8);
    for (int step = 0; step < 12; ++step) {
        run.move_to(motion.next());
        const int cut = (3 * step) % (run.strip_count() + 1);
        ASSERT_EQ(run.find({{cut, run.strip_count() - cut}}),
                  Detection(motion.now(), cpus(1), kPlenty).find())
            << "step " << step;
    }
}

TEST_P(ContactPairsOf, AreTheSameOnOpenClOfEveryKind) {
    if (opencl_devices().empty()) GTEST_SKIP() << "no OpenCL device here";
    const Found expected = Detection(mesh_, cpus(1), kPlenty).find();
    for (const MemoryModel memory : {MemoryModel::kHost, MemoryModel::kDiscrete}) {
        for (const int lanes : {1, 8}) {
            for (const EntryStyle style : {EntryStyle::kPerStrip, EntryStyle::kPerGroup}) {
                SCOPED_TRACE(testing::Message()
                             << name_of(memory) << ", " << lanes << " lanes, "
                             << (style == EntryStyle::kPerGroup ? "groups" : "strips"));
                Devices alone;
                add_opencl(alone, memory, lanes, style);
                EXPECT_EQ(Detection(mesh_, std::move(alone), 5).find(), expected);
                Devices mixed = cpus(1);
                add_opencl(mixed, memory, lanes, style);
                EXPECT_EQ(Detection(mesh_, std::move(mixed), 5).find(), expected);
            }
        }
    }
}

std::string name_of_mesh(const testing::TestParamInfo<std::size_t>& info) {
    std::string name = contact_meshes()[info.param].name;
    std::ranges::replace(name, ' ', '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Meshes, ContactPairsOf,
                         testing::Range(std::size_t{0}, contact_meshes().size()), name_of_mesh);

}  // namespace
}  // namespace weft::test
