#include "simulation/solver/tied_parts.h"

#include <algorithm>
#include <utility>

#include "kernels/bodies/moments.h"
#include "kernels/bodies/ties.h"
#include "simulation/families/stitches/stitches.h"

namespace weft {

namespace {

constexpr int kColumns = WEFT_RUN_COLUMNS;
constexpr int kMoments = WEFT_MOMENT_PARTS;
constexpr int kRounds = 2;         ///< they turn what they shift
constexpr int kRoundsOfPairs = 6;  ///< and parts that are tied to each other wait for each other

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// How many ties each part has.
std::vector<std::size_t> tie_counts(const TieTable& table) {
    std::vector<std::size_t> counts(table.vertices.size());
    for (const PartTie& tie : table.ties) ++counts[at(tie.part)];
    return counts;
}

std::vector<std::size_t> vertex_counts(const TieTable& table) {
    std::vector<std::size_t> counts;
    for (const auto& vertices : table.vertices) counts.push_back(vertices.size());
    return counts;
}

}  // namespace

TiedParts::Layout::Layout(TieTable found, const Model& model)
    : table(std::move(found)),
      masses(table.vertices.size()),
      members(lay_in_columns(vertex_counts(table))),
      ties(lay_in_columns(tie_counts(table))) {
    for (int part = 0; part < part_count(); ++part) {
        for (const int vertex : table.vertices[at(part)]) {
            vertices.push_back(vertex);
            parts.push_back(part);
            masses[at(part)] += model.masses[at(vertex)];
        }
    }
}

TiedParts::Items::Items(const char* name, int count, int strips) : begin(name, at(strips) + 1) {
    std::fill(begin.data() + 1, begin.data() + begin.count(), count);
}

std::unique_ptr<TiedParts> TiedParts::of(Model& model, Buffer<float4>& targets, int kind) {
    const Layout layout(find_part_ties(model), model);
    if (layout.part_count() == 0) return nullptr;
    return std::unique_ptr<TiedParts>(new TiedParts(model, layout, targets, kind));
}

TiedParts::TiedParts(Model& model, const Layout& layout, Buffer<float4>& targets, int kind)
    : model_(model),
      targets_(targets),
      part_count_(layout.part_count()),
      vertices_("ties.vertices", layout.vertices.size()),
      vertex_parts_("ties.vertex_parts", layout.vertices.size()),
      member_rows_("ties.member_rows", layout.members.rows.size()),
      members_("ties.members", layout.members.entries.size()),
      shares_("ties.shares", members_.count()),
      tie_rows_("ties.rows", layout.ties.rows.size()),
      ends_("ties.ends", 2 * layout.ties.entries.size()),
      end_parts_("ties.end_parts", ends_.count()),
      springs_("ties.springs", 4 * layout.ties.entries.size()),
      origins_("ties.origins", at(kColumns * part_count_)),
      first_("ties.first", at(part_count_)),
      sum_starts_("ties.sum_starts", at(kMoments * part_count_)),
      sum_places_("ties.sum_places", sum_starts_.count()),
      still_("ties.still", at(model.scene.substeps)),
      partials_("ties.partials", at(kMoments) * origins_.count()),
      sums_("ties.moments", at(kMoments * (part_count_ + 1))),
      pulls_("ties.pulls", at(WEFT_TIE_PARTS) * origins_.count()),
      motions_("ties.motions", at(3 * (part_count_ + 1))),
      each_vertex_("ties.each_vertex", static_cast<int>(vertices_.count()), model.strips.count()),
      each_column_("ties.each_column", kColumns * part_count_, model.strips.count()),
      each_sum_("ties.each_sum", kMoments * part_count_, model.strips.count()),
      each_part_("ties.each_part", part_count_, model.strips.count()) {
    fill_members(layout);
    fill_ties(layout);
    fill_parts(layout);
    const auto is_pair = [](const PartTie& tie) { return tie.other_part != PartTie::kNone; };
    const bool pairs = std::ranges::any_of(layout.table.ties, is_pair);
    body_ = {kinds().front(), kind, launches(pairs ? kRoundsOfPairs : kRounds)};
}

void TiedParts::fill_members(const Layout& layout) {
    std::ranges::copy(layout.vertices, vertices_.data());
    std::ranges::copy(layout.parts, vertex_parts_.data());
    std::ranges::copy(layout.members.rows, member_rows_.data());
    std::vector<double> shares;
    for (std::size_t k = 0; k < layout.vertices.size(); ++k) {
        shares.push_back(model_.masses[at(layout.vertices[k])] /
                         layout.masses[at(layout.parts[k])]);
    }
    weft::fill_members(layout.members, layout.vertices, shares, members_, shares_);
}

/// Fillers have no stiffness.
void TiedParts::fill_ties(const Layout& layout) {
    std::ranges::copy(layout.ties.rows, tie_rows_.data());
    const std::size_t count = layout.ties.entries.size();
    for (std::size_t e = 0; e < count; ++e) {
        const int k = layout.ties.entries[e];
        if (k == PartColumns::kFiller) {
            for (Buffer<int>* ends : {&ends_, &end_parts_}) {
                (*ends)[e] = (*ends)[e - 1];
                (*ends)[count + e] = (*ends)[count + e - 1];
            }
            continue;
        }
        const PartTie& tie = layout.table.ties[at(k)];
        const bool is_alone = tie.other_part == PartTie::kNone;
        ends_[e] = tie.vertex;
        ends_[count + e] = tie.other;
        end_parts_[e] = tie.part;
        end_parts_[count + e] = is_alone ? part_count_ : tie.other_part;
        const double stiffness =
            tie.tie.stiffness * model_.h * model_.h / layout.masses[at(tie.part)];
        springs_[e] = static_cast<float>(tie.tie.rest);
        springs_[count + e] = static_cast<float>(tie.tie.rate);
        springs_[2 * count + e] = static_cast<float>(stiffness);
        springs_[3 * count + e] = static_cast<float>(is_alone ? stiffness : 2.0 * stiffness);
    }
}

void TiedParts::fill_parts(const Layout& layout) {
    for (int part = 0; part < part_count_; ++part) {
        first_[at(part)] = part;
        const auto& vertices = layout.table.vertices[at(part)];
        std::fill_n(origins_.data() + kColumns * part, kColumns, vertices[vertices.size() / 2]);
        for (int k = 0; k < kMoments; ++k) {
            sum_starts_[at(kMoments * part + k)] = k * kColumns * part_count_ + kColumns * part;
            sum_places_[at(kMoments * part + k)] = kMoments * part + k;
        }
    }
}

std::vector<Launch> TiedParts::launches(int rounds) {
    auto* stitches = model_.find<Stitches>();
    Buffer<float>& clock = stitches != nullptr ? *stitches->clock : still_;
    const int columns = kColumns * part_count_;
    std::vector<Launch> list{
        launch(kernels::add_moments, each_column_.segments(), *model_.positions, targets_, targets_,
               targets_, members_, shares_, member_rows_, origins_, partials_, 0, columns),
        launch(kernels::add_columns, each_sum_.segments(), partials_, sum_starts_, sum_places_,
               sums_),
        launch(kernels::start_parts, each_part_.segments(), sums_, first_, motions_, part_count_)};
    for (int round = 0; round < rounds; ++round) {
        list.push_back(launch(kernels::pull_parts, each_column_.segments(), *model_.positions,
                              ends_, end_parts_, springs_, tie_rows_, motions_, clock, pulls_,
                              static_cast<int>(ends_.count() / 2), part_count_, columns,
                              kInstance));
        list.push_back(launch(kernels::step_parts, each_part_.segments(), sums_, first_, pulls_,
                              motions_, part_count_, columns));
    }
    list.push_back(launch(kernels::move_parts, each_vertex_.segments(), *model_.positions,
                          vertices_, vertex_parts_, motions_, part_count_));
    return list;
}

void TiedParts::add(Step& step) {
    step.add(body_, 0, {0, 1})
        .reads(targets_, 0, model_.vertex_count())
        .updates(*model_.positions, 0, model_.vertex_count());
}

}  // namespace weft
