#pragma once

#include <functional>
#include <string>
#include <vector>

#include "simulation/families/block_rows.h"
#include "simulation/families/family.h"

namespace weft {

/// For families whose blocks share much that is to be computed: elements give theirs once, and the
/// rows of blocks add them up. A strip's own blocks take *pieces*, the elements that it has a part
/// of: one that lies across a border is a piece of both sides, so that no strip waits for another
/// one. See kernels/newton/blocks.h.
class ElementBlockTables {
public:
    /// name: of the buffers
    ElementBlockTables(const std::string& name, const Elements& elements, const BlockList& list);

    int piece_count() const { return static_cast<int>(pieces_.elements.size()); }
    const Segments& segments() const { return segments_; }
    /// [arity * pieces] column-major
    Buffer<int>& corners() { return corners_; }
    /// [pieces] where each piece's blocks begin: those of corners 0 and 1, 0 and 2, ... 1 and 2,
    /// ...
    Buffer<int>& places() { return places_; }
    /// Tasks that fill it also empty it, so nobody else has to know of it.
    Buffer<float4>& blocks() { return blocks_; }
    /// table: [columns * pieces] column-major
    void fill(Buffer<float>& table, const std::function<FewNumbers(int element)>& numbers) const;

    /// Adds up what the pieces have given.
    Launch sum(const BlockTarget& target);

private:
    struct Pieces {
        explicit Pieces(const BlockList& list);
        int of(int strip, int element) const;

        std::vector<int> elements;  ///< by ascending number within a strip
        std::vector<int> begin{0};  ///< [strips + 1]
    };
    void fill_pieces(const Elements& elements);
    void fill_rows(const BlockList& list, int arity);

    Pieces pieces_;
    int per_piece_;  ///< float4 of its blocks
    SlicedRows rows_;
    Buffer<int> segment_begin_;
    Segments segments_;
    Buffer<int> corners_, places_;
    Buffer<float4> blocks_;
    Buffer<int> row_places_;
    Buffer<float> turned_;
};

}  // namespace weft
