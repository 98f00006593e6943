#include "kernels/exchange.h"

#include <gtest/gtest.h>

#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

/// Eleven vertices, so that packs of eight are not all full.
constexpr std::size_t kCount = 11;

struct Merged {
    Buffer<float4> own{"own", kCount};
    Buffer<float4> start{"start", kCount};
    Buffer<float4> input{"input", kCount};

    Merged() {
        Random random(7);
        for (std::size_t v = 0; v < kCount; ++v) {
            start[v] = random.point(1.0f);
            own[v] = moves_own(v) ? random.point(1.0f) : start[v];
            input[v] = moves_input(v) ? random.point(1.0f) : start[v];
            own[v].w = 3.0f;
        }
    }
    static bool moves_own(std::size_t v) { return v % 2 == 0; }
    static bool moves_input(std::size_t v) { return v % 3 == 0; }

    void merge(float own_weight, float input_weight) {
        run(launch(kernels::merge_displacements, Segments{}, own, start, input, own_weight,
                   input_weight));
    }
    void average() { run(launch(kernels::average_positions, Segments{}, own, input)); }

private:
    static void run(const Launch& launch) {
        run_on_host(launch, launch.kernel->form(8), 0, kCount);
    }
};

TEST(Exchange, MotionOfOneSideIsTakenInFull) {
    Merged m;
    const Merged before;
    m.merge(0.5f, 0.5f);
    for (std::size_t v = 0; v < kCount; ++v) {
        if (Merged::moves_own(v) && Merged::moves_input(v)) continue;
        const float4& expected = Merged::moves_own(v) ? before.own[v] : before.input[v];
        EXPECT_EQ(m.own[v].x, expected.x) << v;
        EXPECT_EQ(m.own[v].y, expected.y) << v;
        EXPECT_EQ(m.own[v].z, expected.z) << v;
    }
}

TEST(Exchange, MotionOfBothIsWeighted) {
    Merged m;
    const Merged before;
    m.merge(0.75f, 0.5f);
    for (std::size_t v = 0; v < kCount; v += 6) {
        const float a = before.own[v].y - before.start[v].y;
        const float b = before.input[v].y - before.start[v].y;
        EXPECT_FLOAT_EQ(m.own[v].y, before.start[v].y + 0.75f * a + 0.5f * b) << v;
    }
}

TEST(Exchange, TheMassIsTheOwn) {
    Merged m;
    m.merge(1.0f, 1.0f);
    m.average();
    for (const float4& vertex : m.own.span()) EXPECT_EQ(vertex.w, 3.0f);
}

TEST(Exchange, TheMeanOfPositionsKnowsNoStart) {
    Merged m;
    const Merged before;
    m.average();
    for (std::size_t v = 0; v < kCount; ++v) {
        EXPECT_FLOAT_EQ(m.own[v].z, 0.5f * (before.own[v].z + before.input[v].z)) << v;
    }
}

}  // namespace
}  // namespace weft::test
