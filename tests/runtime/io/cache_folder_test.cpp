#include "runtime/io/cache_folder.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tests/joining_thread.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

class CacheTest : public testing::Test {
protected:
    CacheTest() { fs::remove_all(folder_); }
    ~CacheTest() override { fs::remove_all(folder_); }

    fs::path folder_ = fs::path(testing::TempDir()) / "weft_cache";
    fs::path file_ = folder_ / "below" / "file";
};

/// The variables that name the folder, as they were again when it is over.
class CacheFolderTest : public testing::Test {
protected:
    CacheFolderTest() {
        for (const char* name : kNames) {
            const char* value = std::getenv(name);
            before_.push_back(value == nullptr ? std::nullopt : std::optional<std::string>(value));
        }
    }
    ~CacheFolderTest() override { set(before_[0], before_[1], before_[2]); }

    using Value = std::optional<std::string>;
    static void set(const Value& own, const Value& xdg, const Value& home) {
        const Value* const values[] = {&own, &xdg, &home};
        for (std::size_t i = 0; i < 3; ++i) {
            if (*values[i])
                ::setenv(kNames[i], (*values[i])->c_str(), 1);
            else
                ::unsetenv(kNames[i]);
        }
    }

private:
    static constexpr const char* kNames[] = {"WEFT_CACHE_DIR", "XDG_CACHE_HOME", "HOME"};
    std::vector<Value> before_;
};

TEST_F(CacheFolderTest, IsTheFirstThatIsNamed) {
    set("/own", "/xdg", "/home/me");
    EXPECT_EQ(cache_folder(), "/own");
    set({}, "/xdg", "/home/me");
    EXPECT_EQ(cache_folder(), "/xdg/weft");
    set({}, {}, "/home/me");
    EXPECT_EQ(cache_folder(), "/home/me/.cache/weft");
    set({}, {}, {});
    EXPECT_EQ(cache_folder(), "");
}

/// A relative folder would be another one wherever the program is called.
TEST_F(CacheFolderTest, AnEmptyVariableIsAsGoodAsNone) {
    set("", "/xdg", "/home/me");
    EXPECT_EQ(cache_folder(), "/xdg/weft");
    EXPECT_EQ(cache_folder_trouble(), "");
    set("", "", "/home/me");
    EXPECT_EQ(cache_folder(), "/home/me/.cache/weft");
    set("", "", "");
    EXPECT_EQ(cache_folder(), "");
}

TEST_F(CacheTest, GivesBackWhatWasWritten) {
    EXPECT_EQ(read_cached(file_), "");
    write_cached(file_, "one");
    write_cached(file_, "two");
    EXPECT_EQ(read_cached(file_), "two");
}

// Threads have one process number, as two processes on two machines may have.
TEST_F(CacheTest, IsWholeWhoeverElseWrites) {
    constexpr std::size_t kBytes = 1 << 18;
    std::atomic<int> writing = 8;
    {
        std::vector<JoiningThread> writers;
        for (char letter = 'a'; letter < 'a' + 8; ++letter) {
            writers.emplace_back([&, letter] {
                for (int i = 0; i < 20; ++i) write_cached(file_, std::string(kBytes, letter));
                --writing;
            });
        }
        while (writing > 0) {
            const std::string read = read_cached(file_);
            if (read.empty()) continue;
            ASSERT_EQ(read, std::string(kBytes, read[0]));
        }
    }
    EXPECT_EQ(std::distance(fs::directory_iterator(file_.parent_path()), {}), 1);
}

TEST_F(CacheTest, WhatCannotBeWrittenIsPassedOver) {
    write_cached(folder_, "a file where a folder would have to be");
    write_cached(file_, "one");
    EXPECT_EQ(read_cached(file_), "");
}

TEST_F(CacheTest, OneAtATimeHasTheLock) {
    // Atomic, since thread sanitizers do not know locks of files; but what two do at a time is
    // lost.
    std::atomic<int> count = 0;
    {
        std::vector<JoiningThread> threads;
        for (int t = 0; t < 8; ++t) {
            threads.emplace_back([&] {
                for (int i = 0; i < 100; ++i) {
                    const CacheLock lock(file_);
                    const int seen = count.load(std::memory_order_relaxed);
                    std::this_thread::yield();
                    count.store(seen + 1, std::memory_order_relaxed);
                }
            });
        }
    }
    EXPECT_EQ(count, 800);
}

}  // namespace
}  // namespace weft::test
