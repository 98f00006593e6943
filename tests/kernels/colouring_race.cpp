// What a wrong colouring looks like to a race detector: two springs of one colour share a vertex.
// Under oclgrind this program has to be reported; with `right`, the same springs in two colours, it
// must not be. Otherwise it does nothing of interest.

#include <cstdio>
#include <string_view>

#include "kernels/xpbd/springs.h"
#include "runtime/device_list.h"
#include "runtime/executor.h"

namespace {

using namespace weft;

void run(bool is_right, EntryStyle style) {
    const bool per_strip = style == EntryStyle::kPerStrip;
    Buffer<float4> positions("positions", 3);
    Buffer<int> ends("ends", 4);
    Buffer<float> material("material", 4);
    Buffer<float> multipliers("multipliers", 2);
    Buffer<int> begin("segments", 3);
    for (std::size_t v = 0; v < 3; ++v) positions[v] = {static_cast<float>(v), 0.0f, 0.0f, 1.0f};
    ends[1] = 1;  // spring 0: 0 - 1, spring 1: 1 - 2
    ends[2] = 1;
    ends[3] = 2;
    for (std::size_t s = 0; s < 2; ++s) {
        material[s] = 0.5f;
        material[s + 2] = 1e-4f;
    }

    // Right: one strip with two colours. Wrong: both springs in one colour, or, where a work-item
    // has a whole strip, in two strips.
    Segments segments{&begin, 0, 1, 1};
    if (is_right)
        segments.colour_count = 2;
    else if (per_strip)
        segments.strip_count = 2;
    begin[1] = is_right || per_strip ? 1 : 2;
    begin[2] = 2;

    const TaskBody body{"springs",
                        0,
                        {launch(kernels::project_springs, segments, positions, ends, material,
                                multipliers, 2, 1e4f, 1)}};
    Step step;
    step.add(body, 0, {0, segments.strip_count})
        .updates(positions, 0, 3)
        .updates(multipliers, 0, 2);
    step.seal();
    scheduler::Plan plan;
    plan.placements = {{0.0, 1.0, 0}};
    plan.order_by_start(1);

    DeviceOptions options;
    options.opencl_lanes = 1;
    options.entry_style = style;
    options.group_size = 2;
    const auto devices = open_devices("opencl:0", options);
    const TaskBody* const bodies[] = {&body};
    Executor({devices.front().get()}, bodies).run(step, plan, 1);
}

EntryStyle style_of(std::string_view name) {
    if (name == "strip") return EntryStyle::kPerStrip;
    return name == "group" ? EntryStyle::kPerGroup : EntryStyle::kPerColour;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    run(argv[1] == std::string_view("right"), style_of(argv[2]));
    std::puts("1 test ran.");
}
