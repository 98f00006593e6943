#include <weft/runner.h>
#include <weft/version.h>

#include "halve_kernels.h"

/// The state after some halvings on these devices; the only thing that this library hands on.
__attribute__((visibility("default"))) std::string state_after_halving(const char* devices);

std::string state_after_halving(const char* devices) {
    weft::require_matching_library();
    weft::Buffer<float> values("values", 1003);
    weft::Buffer<int> begin("strips", 9);
    const weft::Segments strips = weft::even_strips(begin, 1003);
    for (int v = 0; v < 1003; ++v) values[static_cast<std::size_t>(v)] = static_cast<float>(v);
    weft::StripWork work(8);
    work.add("halve", weft::launch(halve::predict, strips, values, 0.5f)).updates(values, strips);
    weft::Runner runner(work, {.devices = devices});
    for (int frame = 0; frame < 5; ++frame) runner.advance(3);
    return runner.state_hash();
}
