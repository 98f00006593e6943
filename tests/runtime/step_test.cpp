#include "runtime/step.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <random>
#include <set>
#include <stdexcept>

namespace weft::test {
namespace {

using Pairs = std::set<std::pair<int, int>>;

/// Tasks without a body over a few buffers.
class Accesses {
public:
    Accesses() {
        for (int i = 0; i < 3; ++i) {
            buffers.push_back(std::make_unique<Buffer<float>>("b" + std::to_string(i), 100));
        }
    }
    Step::Adding add() { return step.add(body, 0, {0, 0}); }

    std::vector<std::unique_ptr<Buffer<float>>> buffers;
    TaskBody body;
    Step step;
};

Pairs pairs(const std::vector<Dependency>& dependencies) {
    Pairs set;
    for (const Dependency& d : dependencies) set.emplace(d.from, d.to);
    return set;
}

TEST(Step, ReadAfterWriteWriteAfterReadWriteAfterWrite) {
    Accesses a;
    a.add().updates(*a.buffers[0], 0, 10);
    a.add().reads(*a.buffers[0], 5, 6);    // after write
    a.add().updates(*a.buffers[0], 5, 6);  // after read, and after write
    a.add().reads(*a.buffers[0], 0, 5);    // of task 0 alone
    a.add().reads(*a.buffers[1], 0, 100);  // of nobody
    a.step.seal();
    EXPECT_EQ(pairs(a.step.dependencies()), (Pairs{{0, 1}, {1, 2}, {0, 3}}));
    // The next instance's first task overwrites what the last ones read and wrote.
    EXPECT_EQ(pairs(a.step.carried()), (Pairs{{2, 0}, {3, 0}}));
}

TEST(Step, ReadersDoNotWaitForEachOther) {
    Accesses a;
    for (int i = 0; i < 4; ++i) a.add().reads(*a.buffers[0], 0, 100);
    a.step.seal();
    EXPECT_TRUE(a.step.dependencies().empty());
    EXPECT_TRUE(a.step.carried().empty());
}

TEST(Step, BytesAreWhatIsReadOfWhatWasWritten) {
    Accesses a;
    a.add().updates(*a.buffers[0], 0, 10).updates(*a.buffers[1], 0, 10);
    a.add().reads(*a.buffers[0], 5, 20).reads(*a.buffers[1], 9, 10);
    a.add().updates(*a.buffers[0], 15, 20);  // only overwrites what was read
    a.step.seal();
    ASSERT_EQ(a.step.dependencies().size(), 2U);
    EXPECT_EQ(a.step.dependencies()[0].bytes, 6.0 * sizeof(float));
    EXPECT_EQ(a.step.dependencies()[1].bytes, 0.0);
}

TEST(Segments, LargestIsTheMostItemsOfAColourInAStrip) {
    Buffer<int> begin("begin", 5);
    const std::array<int, 5> at{0, 0, 3, 5, 5};
    std::ranges::copy(at, begin.data());
    const Segments table{&begin, 0, 2, 2};  // strip 0: 0 and 3 items; strip 1: 2 and 0
    EXPECT_EQ(table.largest(0, 0, 1), 0);
    EXPECT_EQ(table.largest(0, 0, 2), 2);
    EXPECT_EQ(table.largest(1, 0, 2), 3);
    EXPECT_EQ(table.largest(1, 1, 2), 0);
    EXPECT_EQ(table.largest(1, 1, 1), 0);
}

/// Some OpenCL drivers use memory in place only where it begins with a page.
TEST(Buffer, BeginsWithAPageOfZeros) {
    for (const std::size_t count : {1U, 1500U, 3U << 20}) {
        const Buffer<float> buffer("buffer", count);
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(buffer.host()) % 4096, 0U) << count;
        EXPECT_EQ(std::ranges::count(buffer.span(), 0.0f), static_cast<long>(count));
    }
}

TEST(Step, RefusesRangesOutsideOfTheBuffer) {
    Accesses a;
    EXPECT_THROW(a.add().reads(*a.buffers[0], -1, 5), std::logic_error);
    EXPECT_THROW(a.add().updates(*a.buffers[0], 90, 101), std::logic_error);
    EXPECT_NO_THROW(a.add().updates(*a.buffers[0], 90, 100));
    EXPECT_NO_THROW(a.add().updates(*a.buffers[0], 200, 200)) << "nothing is nowhere";

    Buffer<int> begin("begin", 4);
    const Segments table{&begin, 0, 1, 3};
    for (int strip = 0; strip <= 3; ++strip) begin[static_cast<std::size_t>(strip)] = 40 * strip;
    const auto updates = [&](int first, int end) {
        a.step.add(a.body, 0, {first, end}).updates(*a.buffers[0], table);
    };
    a.body.launches.clear();
    EXPECT_NO_THROW(updates(0, 2));
    EXPECT_THROW(updates(2, 3), std::logic_error) << "items 80 to 120 of 100";
    EXPECT_THROW(updates(3, 4), std::logic_error) << "a strip that is not there";
}

TEST(Step, RefusesUnitsThatCannotBeCompared) {
    Buffer<int> begin("begin", 8), other("other", 4);
    for (int i = 0; i < 4; ++i) {
        begin[static_cast<std::size_t>(i)] = other[static_cast<std::size_t>(i)] = 10 * i;
        begin[static_cast<std::size_t>(4 + i)] = 30 + 10 * i;
    }
    const Segments first{&begin, 0, 1, 3}, behind{&begin, 4, 1, 3}, across{&begin, 2, 1, 3};
    const Segments elsewhere{&other, 0, 1, 3};
    const auto seal_with = [](const Segments& one, const Segments* two) {
        Accesses a;
        a.step.add(a.body, 0, {0, 3}).updates(*a.buffers[0], one);
        if (two != nullptr)
            a.step.add(a.body, 0, {0, 3}).updates(*a.buffers[0], *two);
        else
            a.step.add(a.body, 0, {0, 3}).reads(*a.buffers[0], 0, 3);
        a.step.seal();
        return a.step.dependencies().size();
    };
    EXPECT_EQ(seal_with(first, &behind), 0U);
    const Segments copy = first;
    EXPECT_EQ(seal_with(first, &copy), 1U) << "a table is where it lies, not who tells of it";
    EXPECT_THROW(seal_with(first, &across), std::logic_error);
    EXPECT_THROW(seal_with(first, &elsewhere), std::logic_error);
    EXPECT_THROW(seal_with(first, nullptr), std::logic_error) << "strips and elements";
}

TEST(Step, SegmentsOfOneBufferAreDifferentTables) {
    Buffer<int> begin("begin", 21);
    const Segments seams{&begin, 0, 1, 10};
    const Segments strips{&begin, 10, 1, 10};
    Buffer<float> multipliers("multipliers", 100);
    TaskBody body;
    Step step;
    step.add(body, 0, {0, 0});  // accesses nothing
    const auto add = [&](const Segments& table, int first, int end) {
        body.launches = {{nullptr, {}, table}};
        step.add(body, 0, {first, end}).updates(multipliers, table);
    };
    add(seams, 0, 5);
    add(strips, 0, 5);
    add(seams, 4, 6);
    step.seal();
    EXPECT_EQ(pairs(step.dependencies()), (Pairs{{1, 3}}));
}

/// Everything that must come before everything else in two instances in a row, by brute force.
std::vector<std::vector<bool>> required_order(const std::vector<Task>& tasks) {
    const int count = static_cast<int>(tasks.size());
    const auto conflict = [&](int i, int j) {
        for (const Access& x : tasks[static_cast<std::size_t>(i % count)].accesses) {
            for (const Access& y : tasks[static_cast<std::size_t>(j % count)].accesses) {
                if (x.buffer != y.buffer || !(x.writes || y.writes)) continue;
                for (int e = x.begin; e < x.end; ++e) {
                    if (e >= y.begin && e < y.end) return true;
                }
            }
        }
        return false;
    };
    std::vector<std::vector<bool>> before(static_cast<std::size_t>(2 * count),
                                          std::vector<bool>(static_cast<std::size_t>(2 * count)));
    for (int j = 0; j < 2 * count; ++j) {
        for (int i = 0; i < j; ++i) {
            if (conflict(i, j))
                before[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = true;
        }
    }
    return before;
}

void close_transitively(std::vector<std::vector<bool>>& before) {
    const std::size_t count = before.size();
    for (std::size_t k = 0; k < count; ++k) {
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t j = 0; before[i][k] && j < count; ++j) {
                if (before[k][j]) before[i][j] = true;
            }
        }
    }
}

/// The order that dependencies make in two instances in a row.
std::vector<std::vector<bool>> made_order(const Step& step) {
    const std::size_t count = step.tasks().size();
    std::vector<std::vector<bool>> before(2 * count, std::vector<bool>(2 * count));
    for (const Dependency& d : step.dependencies()) {
        const auto from = static_cast<std::size_t>(d.from);
        const auto to = static_cast<std::size_t>(d.to);
        before[from][to] = before[count + from][count + to] = true;
    }
    for (const Dependency& d : step.carried()) {
        before[static_cast<std::size_t>(d.from)][count + static_cast<std::size_t>(d.to)] = true;
    }
    return before;
}

TEST(Step, DependenciesMakeExactlyTheRequiredOrderAndNoneIsSuperfluous) {
    for (unsigned seed = 0; seed < 300; ++seed) {
        std::mt19937 random(seed);
        Accesses a;
        // Now and then more than a word has bits for.
        const int tasks = 1 + static_cast<int>(random() % (seed % 30 == 0 ? 100 : 14));
        for (int t = 0; t < tasks; ++t) {
            auto task = a.add();
            for (unsigned n = random() % 4; n > 0; --n) {
                Buffer<float>& buffer = *a.buffers[random() % a.buffers.size()];
                const int begin = static_cast<int>(random() % 20);
                const int end = begin + static_cast<int>(random() % 6);  // sometimes empty
                if (random() % 2 == 0)
                    task.reads(buffer, begin, end);
                else
                    task.updates(buffer, begin, end);
            }
        }
        a.step.seal();
        auto required = required_order(a.step.tasks());
        close_transitively(required);
        auto made = made_order(a.step);
        const auto direct = made;
        close_transitively(made);
        ASSERT_EQ(required, made) << "seed " << seed;

        // No dependency within an instance follows from two others.
        const std::size_t count = a.step.tasks().size();
        for (const Dependency& d : a.step.dependencies()) {
            const auto from = static_cast<std::size_t>(d.from);
            const auto to = static_cast<std::size_t>(d.to);
            for (std::size_t via = 0; via < count; ++via) {
                ASSERT_FALSE(made[from][via] && made[via][to]) << "seed " << seed;
            }
        }
        ASSERT_EQ(pairs(a.step.dependencies()).size(), a.step.dependencies().size()) << "twice";
        ASSERT_EQ(pairs(a.step.carried()).size(), a.step.carried().size()) << "twice";
    }
}

}  // namespace
}  // namespace weft::test
