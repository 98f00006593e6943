#include "simulation/families/element_block_tables.h"

#include <algorithm>
#include <ranges>

#include "kernels/newton/blocks.h"

namespace weft {

namespace {

constexpr int kPerBlock = 3;  ///< float4

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Which of an element's blocks is that of corners low < high.
int pair_of(int low, int high, int arity) {
    return low * arity - low * (low + 1) / 2 + high - low - 1;
}

}  // namespace

ElementBlockTables::Pieces::Pieces(const BlockList& list) {
    for (std::size_t s = 0; s + 1 < list.segment_begin.size(); ++s) {
        std::vector<int> own;
        for (int block = list.segment_begin[s]; block < list.segment_begin[s + 1]; ++block) {
            for (const Coupling& c : list[block]) own.push_back(c.element);
        }
        std::ranges::sort(own);
        elements.insert(elements.end(), own.begin(), std::ranges::unique(own).begin());
        begin.push_back(static_cast<int>(elements.size()));
    }
}

int ElementBlockTables::Pieces::of(int strip, int element) const {
    const auto first = elements.begin() + begin[at(strip)];
    const auto last = elements.begin() + begin[at(strip) + 1];
    return static_cast<int>(std::lower_bound(first, last, element) - elements.begin());
}

ElementBlockTables::ElementBlockTables(const std::string& name, const Elements& elements,
                                       const BlockList& list)
    : pieces_(list),
      per_piece_(kPerBlock * elements.arity() * (elements.arity() - 1) / 2),
      rows_(name + ".block_rows", list.segment_begin, list.lengths()),
      segment_begin_(name + ".pieces", pieces_.begin.size()),
      segments_{&segment_begin_, 0, 1, static_cast<int>(pieces_.begin.size()) - 1},
      corners_(name + ".piece_corners", at(elements.arity() * piece_count())),
      places_(name + ".piece_places", pieces_.elements.size()),
      blocks_(name + ".piece_blocks", at(per_piece_ * piece_count() + kPerBlock)),
      row_places_(name + ".block_places", at(rows_.entry_count())),
      turned_(name + ".blocks_turned", at(rows_.entry_count())) {
    fill_pieces(elements);
    fill_rows(list, elements.arity());
}

void ElementBlockTables::fill_pieces(const Elements& elements) {
    std::ranges::copy(pieces_.begin, segment_begin_.span().begin());
    for (int piece = 0; piece < piece_count(); ++piece) {
        places_[at(piece)] = per_piece_ * piece;
        std::size_t place = at(piece);
        for (const int vertex : elements.vertices_of(pieces_.elements[at(piece)])) {
            corners_[place] = vertex;
            place += at(piece_count());
        }
    }
}

/// Behind the pieces' blocks is one of zeros, for what only fills a row up.
void ElementBlockTables::fill_rows(const BlockList& list, int arity) {
    std::ranges::fill(row_places_.span(), per_piece_ * piece_count());
    for (int strip = 0; strip < segments_.strip_count; ++strip) {
        const auto begin = list.segment_begin.begin() + strip;
        for (int block = begin[0]; block < begin[1]; ++block) {
            int k = 0;
            for (const Coupling& c : list[block]) {
                const std::size_t entry = rows_.entry(block, k++);
                const int pair = pair_of(std::min(c.j, c.k), std::max(c.j, c.k), arity);
                row_places_[entry] = per_piece_ * pieces_.of(strip, c.element) + kPerBlock * pair;
                turned_[entry] = c.j < c.k ? 0.0f : 1.0f;
            }
        }
    }
}

void ElementBlockTables::fill(Buffer<float>& table,
                              const std::function<FewNumbers(int element)>& numbers) const {
    for (int piece = 0; piece < piece_count(); ++piece) {
        std::size_t place = at(piece);
        for (const double number : numbers(pieces_.elements[at(piece)])) {
            table[place] = static_cast<float>(number);
            place += at(piece_count());
        }
    }
}

Launch ElementBlockTables::sum(const BlockTarget& t) {
    return launch(kernels::sum_element_blocks, t.segments, rows_.slices(), blocks_, row_places_,
                  turned_, t.blocks, t.block_count, t.columns, SlicedRows::kStride, t.fresh);
}

}  // namespace weft
