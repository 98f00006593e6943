#include "simulation/contact/account.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/contact/begin.h"
#include "kernels/contact/truncation.h"

namespace weft {

namespace {

constexpr float kNothing = 1e-12f;  ///< distances up to this are 0 [m]; kernels/contact/fill.h
constexpr float kFar = 1e29f;       ///< distances beyond this are none [m]; likewise

}  // namespace

ContactAccount::ContactAccount(const Model& model, float range)
    : model_(model),
      range_(range),
      nearest_("contact.nearest", model.positions->count()),
      cut_counts_("contact.cut_counts", 2 * model.positions->count()),
      cut_ways_("contact.cut_ways", model.positions->count()) {
    // Inside of bodies there is nothing to be filled.
    std::ranges::fill(nearest_.span(), WEFT_NO_PLANE);
}

void ContactAccount::add_launch(std::vector<Launch>& launches, Buffer<int>& cut,
                                Buffer<float4>& anchors, Buffer<float4>& goals) {
    launches.push_back(launch(kernels::count_cut, model_.vertices(), cut, anchors, goals,
                              cut_counts_, cut_ways_, model_.vertex_count(), kInstance));
}

void ContactAccount::add_accesses(Step::Adding& task, int first, int last) {
    const int all = model_.vertex_count();
    task.updates(cut_counts_, first, last)
        .updates(cut_counts_, all + first, all + last)
        .updates(cut_ways_, first, last);
}

std::string ContactAccount::trouble() const {
    const auto count = static_cast<std::size_t>(model_.vertex_count());
    int lost = 0;
    int touching = 0;
    for (std::size_t v = 0; v < count; ++v) {
        if (cut_counts_[count + v] > 0) ++lost;
        if (nearest_[v] <= kNothing) ++touching;
    }
    std::string text;
    if (lost > 0) {
        text = fmt::format("contact: {} vertices found no place that all of their contacts allow",
                           lost);
    }
    if (touching > 0) {
        text += fmt::format(
            "{}{} vertices are at distance 0 of a surface, where contact knows no "
            "side to keep them on",
            text.empty() ? "contact: " : ", and ", touching);
    }
    return text;
}

ContactRecord ContactAccount::record() const {
    const auto count = static_cast<std::size_t>(model_.vertex_count());
    ContactRecord record;
    record.least_distance = std::numeric_limits<double>::infinity();
    for (std::size_t v = 0; v < count; ++v) {
        if (nearest_[v] < range_) ++record.touching;
        if (cut_counts_[v] > 0) ++record.truncated;
        if (cut_counts_[count + v] > 0) ++record.lost;
        if (nearest_[v] < kFar)
            record.least_distance =
                std::min(record.least_distance, static_cast<double>(nearest_[v]));
    }
    if (record.truncated > 0)
        record.substeps_wanted = static_cast<std::uint32_t>(substeps_wanted());
    return record;
}

/// So many that inertia leads vertices which were taken back no further in one than contacts let
/// them: planes leave them a good part of the gap before them, and from half of the thickness on
/// they are pushed in time.
int ContactAccount::substeps_wanted() const {
    constexpr double kPart = 0.8;
    double most = 0.0;
    for (int v = 0; v < model_.vertex_count(); ++v) {
        const auto i = static_cast<std::size_t>(v);
        if (cut_counts_[i] == 0) continue;
        const double gap = static_cast<double>(std::max(nearest_[i], 0.5f * range_));
        most = std::max(most, static_cast<double>(cut_ways_[i]) / (kPart * gap));
    }
    const double substeps = std::ceil(most * model_.scene.dt / model_.h);
    return std::max(model_.scene.substeps, static_cast<int>(std::min(substeps, 1e6)));
}

}  // namespace weft
