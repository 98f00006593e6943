#include "simulation/contact/truncation.h"

#include <algorithm>

#include "kernels/contact/truncate.h"

namespace weft {

namespace {

// In parts of the least distance.
constexpr float kSoftSlack = 0.5f;
constexpr float kHardSlack = 0.125f;

}  // namespace

ContactTruncation::ContactTruncation(Model& model, int room, float floor, Buffer<float4>& anchors,
                                     Buffer<int>& touching)
    : model_(model),
      soft_(kSoftSlack * floor),
      hard_(kHardSlack * floor),
      anchors_(anchors),
      touching_(touching),
      apart_("contact.apart", touching.count()),
      table_("contact.planes", model.vertices(), room),
      planes_(table_.add_column<float4>("planes")),
      least_("contact.least", model.positions->count()),
      cut_("contact.cut", model.positions->count()) {
    // Inside of bodies there is nothing to be filled.
    std::ranges::fill(least_.span(), WEFT_NO_PLANE);
}

Launch ContactTruncation::behind_planes(Buffer<float4>& positions, float soft, int all_from) {
    return only_where(touching_, launch(kernels::truncate_contacts, model_.vertices(), positions,
                                        anchors_, least_, table_.rows(), table_.counts(), planes_,
                                        cut_, soft, hard_, kIteration, all_from));
}

Launch ContactTruncation::in_balls(Buffer<float4>& positions, int all_from) {
    return only_where(apart_, launch(kernels::hold_in_balls, model_.vertices(), positions, anchors_,
                                     cut_, kIteration, all_from));
}

void ContactTruncation::add_start(std::vector<Launch>& launches, float slack) {
    launches.push_back(behind_planes(*model_.positions, slack, 0));
    launches.push_back(in_balls(*model_.positions, 0));
}

void ContactTruncation::add(std::vector<Launch>& launches, Buffer<float4>& positions,
                            int all_from) {
    launches.push_back(behind_planes(positions, soft_, all_from));
    launches.push_back(in_balls(positions, all_from));
}

void ContactTruncation::add_accesses(Step::Adding& task, StripRange strips) {
    add_reads(task, strips);
    task.reads(touching_, strips.begin, strips.end)
        .reads(apart_, strips.begin, strips.end)
        .updates(cut_, model_.vertices().item(strips.begin), model_.vertices().item(strips.end));
}

void ContactTruncation::add_reads(Step::Adding& task, StripRange strips) {
    const int first = model_.vertices().item(strips.begin);
    const int last = model_.vertices().item(strips.end);
    task.reads(anchors_, first, last)
        .reads(least_, first, last)
        .reads(table_.counts(), first, last)
        .reads(planes_, table_.entries());
}

}  // namespace weft
