#include "runtime/memory_map.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

namespace weft::test {
namespace {

constexpr int kMemories = 4;
constexpr int kUnits = 24;
constexpr int kBuffers = 2;

/// 0: the host's.
MemoryId memory_number(int number) {
    return number == 0 ? MemoryId::host() : MemoryId::of_device(number - 1);
}

class Done final : public Completion {
public:
    void wait() override {}
    void when_done(std::function<void()> callback) override { callback(); }
};

/// What is known of one unit of one buffer: which memories hold it, and since which command.
struct Unit {
    bool noted = false;  // otherwise current everywhere
    struct Holding {
        Completion* since = nullptr;
        bool copied = false;
    };
    std::map<MemoryId, Holding> holders;
};

/// Unit by unit, what MemoryMap keeps in intervals.
class Reference {
public:
    void written(int buffer, int begin, int end, MemoryId memory, Completion* task) {
        for (int u = begin; u < end; ++u) at(buffer, u) = {true, {{memory, {task, false}}}};
    }
    void arrived(int buffer, int begin, int end, MemoryId memory, Completion* arrival) {
        for (int u = begin; u < end; ++u) at(buffer, u).holders[memory] = {arrival, true};
    }
    void forget(int buffer) { std::fill_n(units_[buffer], kUnits, Unit{}); }
    void settle() {
        for (auto& buffer : units_) {
            for (Unit& unit : buffer) {
                for (auto& [memory, holding] : unit.holders) holding.since = nullptr;
            }
        }
    }
    bool is_missing(int buffer, int u, MemoryId memory) {
        const Unit& unit = at(buffer, u);
        return unit.noted && !unit.holders.contains(memory);
    }
    Unit& at(int buffer, int u) { return units_[buffer][u]; }

private:
    Unit units_[kBuffers][kUnits];
};

class RandomOperations {
public:
    explicit RandomOperations(unsigned seed) : random_(seed) {}

    void run(int operations) {
        for (int i = 0; i < operations && !testing::Test::HasFatalFailure(); ++i) step();
    }

private:
    int pick(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }

    void step() {
        const int buffer = pick(kBuffers);
        const int begin = pick(kUnits - 1);
        const int end = begin + 1 + pick(std::min(8, kUnits - begin));
        const int number = pick(kMemories);
        const MemoryId memory = memory_number(number);
        const Access access{&buffers_[buffer], nullptr, begin, end, true};
        switch (pick(10)) {
            case 0:
                map_.forget(buffers_[buffer]);
                reference_.forget(buffer);
                break;
            case 1:
                map_.settle();
                reference_.settle();
                break;
            case 2:
            case 3:
            case 4:
            case 5: {
                map_.written(access, memory, &done_[number]);
                reference_.written(buffer, begin, end, memory, &done_[number]);
                break;
            }
            default:
                bring(access, buffer, memory);
        }
        check(access, buffer, memory_number(pick(kMemories)));
        check_host(buffer);
    }

    /// As an executor does: every missing part is copied.
    void bring(const Access& access, int buffer, MemoryId memory) {
        for (const auto& missing : map_.missing(access, memory)) {
            map_.arrived(access, missing.interval, memory, &arrival_);
            reference_.arrived(buffer, missing.interval.begin, missing.interval.end, memory,
                               &arrival_);
        }
        ASSERT_TRUE(map_.missing(access, memory).empty());
    }

    void check(const Access& access, int buffer, MemoryId memory) {
        bool found[kUnits] = {};
        MemoryId source_before = memory;
        int end_before = -1;
        for (const auto& missing : map_.missing(access, memory)) {
            std::set<Completion*> makers;
            for (int u = missing.interval.begin; u < missing.interval.end; ++u) {
                ASSERT_TRUE(u >= access.begin && u < access.end && !found[u]);
                found[u] = true;
                const auto& holders = reference_.at(buffer, u).holders;
                const auto source = holders.find(missing.source);
                ASSERT_NE(source, holders.end()) << "unit " << u << " is not current at its source";
                EXPECT_TRUE(missing.source.is_host() || !holders.contains(MemoryId::host()))
                    << "the host is nearer";
                if (source->second.since != nullptr) makers.insert(source->second.since);
            }
            EXPECT_EQ(missing.made_by.size(), makers.size()) << "some maker is named twice";
            EXPECT_EQ(std::set<Completion*>(missing.made_by.begin(), missing.made_by.end()),
                      makers);
            EXPECT_FALSE(missing.source == source_before && missing.interval.begin == end_before)
                << "two stretches where one would do";
            source_before = missing.source;
            end_before = missing.interval.end;
        }
        std::set<Completion*> expected;
        for (int u = access.begin; u < access.end; ++u) {
            EXPECT_EQ(found[u], reference_.is_missing(buffer, u, memory)) << "unit " << u;
            const auto& holders = reference_.at(buffer, u).holders;
            const auto here = holders.find(memory);
            if (here == holders.end() || !here->second.copied) continue;
            if (here->second.since != nullptr) expected.insert(here->second.since);
        }
        const auto arrivals = map_.arrivals(access, memory);
        EXPECT_EQ(std::set<Completion*>(arrivals.begin(), arrivals.end()), expected);
    }

    void check_host(int buffer) {
        bool found[kUnits] = {};
        for (const auto& [access, missing] : map_.missing_at_host(buffers_[buffer])) {
            for (int u = missing.interval.begin; u < missing.interval.end; ++u) found[u] = true;
        }
        for (int u = 0; u < kUnits; ++u) {
            EXPECT_EQ(found[u], reference_.is_missing(buffer, u, MemoryId::host())) << "unit " << u;
        }
    }

    std::mt19937 random_;
    Buffer<float> buffers_[kBuffers]{{"a", kUnits}, {"b", kUnits}};
    Done done_[kMemories];
    Done arrival_;
    MemoryMap map_;
    Reference reference_;
};

TEST(MemoryMap, KeepsWhatAModelUnitByUnitKeeps) {
    for (unsigned seed = 0; seed < 100; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        RandomOperations(seed).run(200);
        if (HasFailure()) return;
    }
}

TEST(MemoryMap, UnknownDataAreCurrentEverywhere) {
    Buffer<float> buffer("b", 10);
    const MemoryMap map;
    EXPECT_TRUE(map.missing({&buffer, nullptr, 0, 10, false}, memory_number(3)).empty());
    EXPECT_TRUE(map.missing_at_host(buffer).empty());
}

TEST(MemoryMap, StripsAreTurnedIntoElementsForCopies) {
    Buffer<int> begin("segments", 7);
    const int values[] = {0, 4, 9, 9, 12, 20, 21};
    std::copy(std::begin(values), std::end(values), begin.data());
    const Segments segments{&begin, 0, 2, 3};  // strips begin at items 0, 9, 12 and end at 21
    Buffer<float> buffer("b", 21);
    const Access access{&buffer, &segments, 0, 3, true};
    EXPECT_EQ(elements_of(access, {1, 3}).begin, 9U);
    EXPECT_EQ(elements_of(access, {1, 3}).end, 21U);
    const Access plain{&buffer, nullptr, 0, 21, true};
    EXPECT_EQ(elements_of(plain, {1, 3}).end, 3U);
}

TEST(MemoryMap, SegmentTablesOfOneBufferAreIndependent) {
    Buffer<int> begin("segments", 9);
    const Segments one{&begin, 0, 1, 4};
    const Segments other{&begin, 4, 1, 4};
    Buffer<float> buffer("b", 21);
    MemoryMap map;
    map.written({&buffer, &one, 0, 4, true}, memory_number(1), nullptr);
    EXPECT_TRUE(map.missing({&buffer, &other, 0, 4, false}, memory_number(2)).empty());
    EXPECT_EQ(map.missing({&buffer, &one, 2, 3, false}, memory_number(2)).size(), 1U);
}

}  // namespace
}  // namespace weft::test
