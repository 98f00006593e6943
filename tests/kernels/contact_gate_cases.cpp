#include "kernels/contact/gates.h"
#include "tests/kernels/contact_case_parts.h"

namespace weft::test {
namespace {

/// Most are 0.
Buffer<int>& add_flags(KernelCase& c, const std::string& name, int count) {
    auto& flags = add_numbers(c, name, count, 20);
    for (int& flag : flags.span()) flag = flag > 18 ? 1 : 0;
    return flags;
}

/// Some strips have no patches.
void awake_case(KernelCase& c) {
    auto& begin = add_begins(c, "begin", c.items, 0, 9);
    const int patches = begin[at(c.items)] + 1;
    auto& near_counts = add_flags(c, "near_counts", patches);
    auto& kept_counts = add_flags(c, "kept_counts", patches);
    auto& stale = add_flags(c, "stale", patches);
    auto& near = c.add<int>("near", c.items);
    auto& awake = c.add<int>("awake", c.items);
    c.launch = launch(kernels::find_awake_strips, c.segments, begin, near_counts, kept_counts,
                      stale, near, awake, kInstance);
}

void touching_case(KernelCase& c) {
    auto& near = add_numbers(c, "near", c.items, 2);
    auto& touching = add_numbers(c, "touching", c.items, 2);
    auto& meeting = c.add<int>("meeting", c.items);
    auto& filling = c.add<int>("filling", c.items);
    auto& apart = c.add<int>("apart", c.items);
    c.launch = launch(kernels::find_touching_strips, c.segments, near, touching, meeting, filling,
                      apart, c.items, kInstance);
}

const bool added =
    add_case("find_awake_strips", awake_case) && add_case("find_touching_strips", touching_case);

}  // namespace
}  // namespace weft::test
