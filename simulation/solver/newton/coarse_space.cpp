#include "simulation/solver/newton/coarse_space.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "kernels/newton/coarse.h"
#include "simulation/solver/accesses.h"

namespace weft {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Most elements are, and couple no pair.
bool is_in_one(const std::vector<int>& aggregate_of, const ElementCorners& corners) {
    return std::ranges::all_of(
        corners, [&](int v) { return aggregate_of[at(v)] == aggregate_of[at(corners[0])]; });
}

}  // namespace

CoarseSpace::CoarseSpace(Model& model, Aggregates aggregates)
    : CoarseSpace(model, aggregates, pairs_of(model, aggregates)) {}

/// All pairs that share an element, sorted.
std::vector<CoarseSpace::Pair> CoarseSpace::pairs_of(const Model& model,
                                                     const Aggregates& aggregates) {
    std::vector<Pair> pairs;
    for (const auto& family : model.families) {
        for (int e = 0; e < family->count(); ++e) {
            const ElementCorners corners = family->corners(e);
            if (is_in_one(aggregates.of, corners)) continue;
            for (const int v : corners) {
                for (const int w : corners) {
                    const int a = aggregates.of[at(v)];
                    const int b = aggregates.of[at(w)];
                    if (a == aggregates.count() || b == a) continue;
                    if (b == aggregates.count()) pairs.push_back({a, a});
                    if (b < a) pairs.push_back({a, b});
                }
            }
        }
    }
    const auto key = [](const Pair& p) { return std::pair(p.a, p.b); };
    std::ranges::sort(pairs, {}, key);
    const auto again = std::ranges::unique(pairs, {}, key);
    pairs.erase(again.begin(), again.end());
    // A single patch that nothing holds has no other: a block of zeros, so that there is one.
    if (pairs.empty()) pairs.push_back({0, 0});
    return pairs;
}

CoarseSpace::CoarseSpace(Model& model, Aggregates given, const std::vector<Pair>& pairs)
    : h2_(model.h * model.h),
      aggregates_(std::move(given)),
      pair_count_(static_cast<int>(pairs.size())),
      width_([&] {
          int most = 0;
          for (const Pair& p : pairs) most = std::max(most, p.a - p.b);
          return 3 * most + 2;
      }()),
      strip_aggregates_("coarse.strips", model.strips.begin.size()),
      strip_pairs_("coarse.strip_pairs", model.strips.begin.size()),
      first_("coarse.first", model.strips.begin.size()),
      pairs_("coarse.pairs", 2 * pairs.size()),
      blocks_("coarse.blocks", 9 * pairs.size()),
      inertia_("coarse.inertia", at(aggregates_.count())),
      band_("coarse.band", at(unknowns() * (width_ + 1))),
      numbers_("coarse.numbers", at(aggregates_.count())),
      places_("coarse.places", at(aggregates_.count())),
      inverse_("coarse.inverse", at(inverse_begin(model.strips.count()))),
      restricted_("coarse.restricted", at(aggregates_.count())),
      corrections_("coarse.corrections", at(aggregates_.count() + 1)),
      aggregate_of_("coarse.aggregate_of", at(model.vertex_count())),
      by_strip_{&strip_aggregates_, 0, 1, model.strips.count()},
      pairs_by_strip_{&strip_pairs_, 0, 1, model.strips.count()},
      first_item_{&first_, 0, 1, model.strips.count()} {
    fill_pairs(model, pairs);
    fill_members(model);
    fill_places(model);
    for (auto& family : model.families) add_family(*family, pairs);
}

void CoarseSpace::fill_pairs(const Model& model, const std::vector<Pair>& pairs) {
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        pairs_[2 * p] = pairs[p].a;
        pairs_[2 * p + 1] = pairs[p].b;
    }
    std::fill(first_.data() + 1, first_.data() + first_.count(), 1);
    for (int s = 0; s <= model.strips.count(); ++s) {
        const int aggregate = s * aggregates_.per_strip;
        strip_aggregates_[at(s)] = aggregate;
        strip_pairs_[at(s)] = static_cast<int>(
            std::ranges::lower_bound(pairs, aggregate, {}, &Pair::a) - pairs.begin());
    }
}

void CoarseSpace::fill_members(const Model& model) {
    std::copy(aggregates_.of.begin(), aggregates_.of.end(), aggregate_of_.data());
    std::vector<int> lengths;
    for (const auto& members : aggregates_.members) {
        lengths.push_back(static_cast<int>(members.size()));
    }
    rows_ = std::make_unique<SlicedRows>("coarse.rows", strip_aggregates_.span(), lengths,
                                         std::min(SlicedRows::kStride, aggregates_.per_strip));
    members_ = std::make_unique<Buffer<int>>("coarse.members", at(rows_->entry_count()));
    shares_ = std::make_unique<Buffer<float>>("coarse.shares", at(rows_->entry_count()));
    for (int a = 0; a < aggregates_.count(); ++a) {
        const auto& members = aggregates_.members[at(a)];
        double mass = 0.0;
        for (std::size_t k = 0; k < members.size(); ++k) {
            (*members_)[rows_->entry(a, static_cast<int>(k))] = members[k];
            (*shares_)[rows_->entry(a, static_cast<int>(k))] = 1.0f;
            mass += model.masses[at(members[k])];
        }
        inertia_[at(a)] = inertia_of(mass);
        // What fills a row up must lie in the strip: tasks read no other residuals.
        const int own = model.strips.begin[at(a / aggregates_.per_strip)];
        for (int k = static_cast<int>(members.size()); k < rows_->length(a); ++k) {
            (*members_)[rows_->entry(a, k)] = own;
        }
    }
}

/// An empty one has no force, and any matrix will do.
float CoarseSpace::inertia_of(double mass) const {
    return mass > 0.0 ? static_cast<float>(mass / h2_) : 1.0f;
}

void CoarseSpace::hold(std::span<const float4> positions) {
    for (int a = 0; a < aggregates_.count(); ++a) {
        const auto& members = aggregates_.members[at(a)];
        double mass = 0.0;
        for (std::size_t k = 0; k < members.size(); ++k) {
            const float w = positions[at(members[k])].w;
            const bool is_free = w > 0.0f;
            if (is_free) mass += 1.0 / static_cast<double>(w);
            aggregate_of_[at(members[k])] = is_free ? a : aggregates_.count();
            (*shares_)[rows_->entry(a, static_cast<int>(k))] = is_free ? 1.0f : 0.0f;
        }
        inertia_[at(a)] = inertia_of(mass);
    }
}

void CoarseSpace::fill_places(const Model& model) {
    const int per_strip = aggregates_.per_strip;
    for (int s = 0; s < model.strips.count(); ++s) {
        for (int k = 0; k < per_strip; ++k) {
            numbers_[at(s * per_strip + k)] = static_cast<float>(s * per_strip + k);
            places_[at(s * per_strip + k)] = inverse_begin(s) + k;
        }
    }
}

void CoarseSpace::add_family(ElementFamily& family, const std::vector<Pair>& pairs) {
    const auto& of = aggregates_.of;
    const auto key = [](const Pair& p) { return std::pair(p.a, p.b); };
    const auto put_element = [&](int e, const auto& put) {
        const ElementCorners corners = family.corners(e);
        if (is_in_one(of, corners)) return;
        for (std::size_t j = 0; j < corners.size(); ++j) {
            for (std::size_t k = 0; k < corners.size(); ++k) {
                const int a = of[at(corners[j])];
                const int b = of[at(corners[k])];
                const bool is_tied = b == aggregates_.count();
                if (a == aggregates_.count() || (b >= a && !is_tied)) continue;
                const std::pair wanted(a, is_tied ? a : b);
                const auto pair = std::ranges::lower_bound(pairs, wanted, {}, key);
                put(static_cast<int>(pair - pairs.begin()),
                    Coupling{e, static_cast<std::int16_t>(j), static_cast<std::int16_t>(k)});
            }
        }
    };
    const Grouped<Coupling> blocks(static_cast<int>(pairs.size()), [&](const auto& put) {
        for (int e = 0; e < family.count(); ++e) put_element(e, put);
    });
    BlockList list;
    list.contributions = blocks.values();
    list.segment_begin.assign(strip_pairs_.span().begin(), strip_pairs_.span().end());
    int begin = 0;
    for (int block = 0; block < blocks.count(); ++block) {
        const auto count = static_cast<int>(blocks[block].size());
        list.ranges.push_back({begin, count});
        begin += count;
    }
    families_.push_back(family.make_block_rows(list));
}

std::vector<Launch> CoarseSpace::couple(const LinearisedAt& where) {
    std::vector<Launch> launches;
    for (const auto& family : families_) {
        const BlockTarget target{pairs_by_strip_,
                                 where.positions,
                                 where.before,
                                 where.after,
                                 blocks_,
                                 pair_count_,
                                 9,
                                 launches.empty() ? 1 : 0};
        std::ranges::move(family->couple(target), std::back_inserter(launches));
    }
    return launches;
}

void CoarseSpace::add_couple_accesses(Step::Adding& task, int first_strip, int end_strip) {
    add_columns(task, blocks_, pair_count_, 9, pairs_by_strip_.item(first_strip),
                pairs_by_strip_.item(end_strip), true);
}

std::vector<Launch> CoarseSpace::factor() {
    return {launch(kernels::factor_coarse, first_item_, pairs_, blocks_, inertia_, band_,
                   pair_count_, aggregates_.count(), width_)};
}

void CoarseSpace::add_factor_accesses(Step::Adding& task) {
    task.reads(blocks_, 0, 9 * pair_count_).updates(band_, 0, unknowns() * (width_ + 1));
}

std::vector<Launch> CoarseSpace::invert() {
    return {launch(kernels::invert_coarse, by_strip_, band_, numbers_, places_, inverse_,
                   aggregates_.count(), width_, aggregates_.per_strip)};
}

void CoarseSpace::add_invert_accesses(Step::Adding& task, int first_strip, int end_strip) {
    task.reads(band_, 0, unknowns() * (width_ + 1))
        .updates(inverse_, inverse_begin(first_strip), inverse_begin(end_strip));
}

Launch CoarseSpace::restrict(Buffer<float4>& residuals) {
    return launch(kernels::restrict_residuals, by_strip_, residuals, *members_, *shares_,
                  rows_->slices(), restricted_, rows_->stride());
}

void CoarseSpace::add_restrict_accesses(Step::Adding& task, int first_strip, int end_strip) {
    task.updates(restricted_, by_strip_.item(first_strip), by_strip_.item(end_strip));
}

Launch CoarseSpace::correct() {
    return launch(kernels::correct_coarse, by_strip_, restricted_, inverse_, places_, corrections_,
                  aggregates_.count(), aggregates_.per_strip);
}

void CoarseSpace::add_correct_accesses(Step::Adding& task, int first_strip, int end_strip) {
    task.reads(restricted_, 0, aggregates_.count())
        .reads(inverse_, inverse_begin(first_strip), inverse_begin(end_strip));
}

}  // namespace weft
