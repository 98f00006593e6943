#include "runtime/unused_memory.h"

#include <gtest/gtest.h>

#include <vector>

#ifdef __GLIBC__
#if __GLIBC_PREREQ(2, 33)
#include <malloc.h>
#define WEFT_HAS_MALLINFO
#endif
#endif

namespace weft {
namespace {

TEST(UnusedMemory, OfListsIsFreed) {
    std::vector<int> list(1000, 1);
    give_back(list);
    EXPECT_TRUE(list.empty());
    EXPECT_EQ(list.capacity(), 0U);
}

TEST(UnusedMemory, OfBuffersCanBeUsedAgain) {
    constexpr std::size_t kCount = std::size_t{1} << 20;
    Buffer<int> buffer("buffer", kCount), beside("beside", kCount);
    for (Buffer<int>* each : {&buffer, &beside}) {
        for (int& value : each->span()) value = 7;
    }
    give_back(buffer);
    for (const int value : beside.span()) ASSERT_EQ(value, 7);
    for (const int value : buffer.span()) ASSERT_TRUE(value == 0 || value == 7);
    for (int& value : buffer.span()) value = 8;
    for (const int value : buffer.span()) ASSERT_EQ(value, 8);
}

#ifdef WEFT_HAS_MALLINFO
TEST(UnusedMemory, OfLargeListsIsOfNoHeap) {
    constexpr std::size_t kBytes = std::size_t{16} << 20;
    give_back_large_lists();
    // glibc's own limit rises with what was freed.
    for (int again = 0; again < 3; ++again) {
        const auto before = ::mallinfo2();
        const std::vector<char> list(kBytes);
        const auto now = ::mallinfo2();
        if (again == 0 && now.hblkhd == 0 && now.uordblks == before.uordblks) {
            GTEST_SKIP() << "the allocator does not tell";
        }
        EXPECT_GE(now.hblkhd, before.hblkhd + kBytes);
    }
}
#endif

}  // namespace
}  // namespace weft
