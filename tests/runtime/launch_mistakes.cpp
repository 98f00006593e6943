// One of these must compile (MISTAKE 0), and all others must not. See launch_mistakes.cmake.

#include "kernels/motion.h"
#include "runtime/launch.h"
#include "runtime/step.h"

weft::Launch bound(const weft::Segments& segments, weft::Buffer<weft::float4>& positions,
                   weft::Buffer<weft::float4>& rest, weft::Buffer<weft::float4>& motions,
                   weft::Buffer<int>& vertices, weft::Buffer<float>& reals);

weft::Launch bound(const weft::Segments& segments, weft::Buffer<weft::float4>& positions,
                   weft::Buffer<weft::float4>& rest, weft::Buffer<weft::float4>& motions,
                   weft::Buffer<int>& vertices, [[maybe_unused]] weft::Buffer<float>& reals) {
    using weft::kInstance;
    using weft::launch;
    using weft::kernels::move_pins;
#if MISTAKE == 0
    weft::Step step;
    const weft::TaskBody body;
    step.add(body, 0, {0, 1}).reads(rest, segments, 0, 1).updates(positions, segments);
    return launch(move_pins, segments, positions, vertices, rest, motions, 2, 1, kInstance);
#elif MISTAKE == 1   // an argument is missing
    return launch(move_pins, segments, positions, vertices, rest, motions, 2, kInstance);
#elif MISTAKE == 2   // one too many
    return launch(move_pins, segments, positions, vertices, rest, motions, 2, 1, kInstance, 1);
#elif MISTAKE == 3   // a float buffer where indices belong
    return launch(move_pins, segments, positions, reals, rest, motions, 2, 1, kInstance);
#elif MISTAKE == 4   // a number where a buffer belongs
    return launch(move_pins, segments, positions, 7, rest, motions, 2, 1, kInstance);
#elif MISTAKE == 5   // a buffer where a number belongs
    return launch(move_pins, segments, positions, vertices, rest, motions, reals, 1, kInstance);
#elif MISTAKE == 6   // a float for an int
    return launch(move_pins, segments, positions, vertices, rest, motions, 2.0f, 1, kInstance);
#elif MISTAKE == 7   // a double for an int
    return launch(move_pins, segments, positions, vertices, rest, motions, 2.0, 1, kInstance);
#elif MISTAKE == 8   // the instance where a buffer belongs
    return launch(move_pins, segments, positions, kInstance, rest, motions, 2, 1, kInstance);
#elif MISTAKE == 9   // a buffer of a type that kernels do not know
    weft::Buffer<double> doubles("doubles", 1);
    return launch(move_pins, segments, positions, doubles, rest, motions, 2, 1, kInstance);
#elif MISTAKE == 10  // data that must not change, where the kernel writes
    const weft::Buffer<weft::float4>& fixed = positions;
    return launch(move_pins, segments, fixed, vertices, rest, motions, 2, 1, kInstance);
#elif MISTAKE == 11  // a body that is gone before its step is run
    weft::Step step;
    step.add(weft::TaskBody{"pins", 0, {}}, 0, {0, 1});
    return {};
#elif MISTAKE == 12  // a strip table that is gone before its step is run
    weft::Step step;
    const weft::TaskBody body;
    step.add(body, 0, {0, 1}).updates(positions, weft::Segments(segments));
    return {};
#endif
}
