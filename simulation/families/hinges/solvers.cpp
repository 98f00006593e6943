#include <algorithm>
#include <utility>

#include "kernels/descent/hinges.h"
#include "kernels/xpbd/hinges.h"
#include "simulation/families/hinges/hinges.h"
#include "simulation/families/sliced_rows.h"
#include "simulation/topology/grouped.h"

namespace weft {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The matrix Q of E = 1/2 x^T Q x, row by row.
struct BendingMatrix {
    struct Weight {
        int vertex;
        int hinge;  ///< the first that it is from
        double value;
    };
    Grouped<Weight> rows;          ///< [vertices] by ascending vertex, no diagonal
    std::vector<int> lengths;      ///< [vertices] of the rows, without what is merged
    std::vector<double> diagonal;  ///< [vertices]

    BendingMatrix(const Hinges& hinges, int vertex_count)
        : rows(vertex_count,
               [&](const auto& put) {
                   for (int h = 0; h < hinges.count(); ++h) put_weights(hinges, h, put);
               }),
          diagonal(static_cast<std::size_t>(vertex_count), 0.0) {
        add_diagonals(hinges);
        for (int v = 0; v < vertex_count; ++v) lengths.push_back(merge(rows[v]));
    }

    std::span<const Weight> row(int vertex) const {
        return rows[vertex].first(
            static_cast<std::size_t>(lengths[static_cast<std::size_t>(vertex)]));
    }

private:
    template <class Put>
    static void put_weights(const Hinges& hinges, int hinge, const Put& put) {
        const auto corners = hinges.corners(hinge);
        for (int j = 0; j < std::ssize(corners); ++j) {
            const double weight = hinges.weight(hinge, j);
            for (int k = 0; k < std::ssize(corners); ++k) {
                if (k == j) continue;
                put(corners[at(j)],
                    Weight{corners[at(k)], hinge, weight * hinges.weight(hinge, k)});
            }
        }
    }

    void add_diagonals(const Hinges& hinges) {
        for (int h = 0; h < hinges.count(); ++h) {
            const auto corners = hinges.corners(h);
            for (int j = 0; j < std::ssize(corners); ++j) {
                diagonal[at(corners[at(j)])] += hinges.weight(h, j) * hinges.weight(h, j);
            }
        }
    }

    /// Adds up the weights of each vertex, by ascending hinge; how many are left.
    static int merge(std::span<Weight> row) {
        std::ranges::sort(row, {}, [](const Weight& w) { return std::pair(w.vertex, w.hinge); });
        std::size_t count = 0;
        for (const Weight& weight : row) {
            if (count == 0 || row[count - 1].vertex != weight.vertex) {
                row[count++] = weight;
            } else {
                row[count - 1].value += weight.value;
            }
        }
        return static_cast<int>(count);
    }
};

std::vector<int> row_lengths(const BendingMatrix& matrix, const VertexItems& items) {
    std::vector<int> lengths;
    for (int i = 0; i < items.count(); ++i) {
        lengths.push_back(matrix.lengths[static_cast<std::size_t>(items.vertex(i))]);
    }
    return lengths;
}

class BendingRows final : public DerivativeRows {
public:
    BendingRows(const Hinges& hinges, const VertexItems& items)
        : BendingRows(BendingMatrix(hinges, items.count()), items) {}

    Launch gather(const DerivativeTarget& t) override {
        return launch(kernels::gather_bending, t.segments, t.positions, t.vertices, rows_.slices(),
                      others_, weights_, diagonal_, t.sums, t.item_count, SlicedRows::kStride,
                      t.fresh);
    }

    Launch gather_gradients(const DerivativeTarget& t) override {
        return launch(kernels::gather_bending_gradients, t.segments, t.positions, t.vertices,
                      rows_.slices(), others_, weights_, t.sums, t.item_count, SlicedRows::kStride,
                      t.fresh);
    }

private:
    BendingRows(const BendingMatrix& matrix, const VertexItems& items)
        : rows_("bending.rows", items.segment_begin(), row_lengths(matrix, items)),
          others_("bending.others", static_cast<std::size_t>(rows_.entry_count())),
          weights_("bending.row_weights", others_.count()),
          diagonal_("bending.diagonal", static_cast<std::size_t>(items.count())) {
        for (int i = 0; i < items.count(); ++i) {
            const auto vertex = static_cast<std::size_t>(items.vertex(i));
            const auto row = matrix.row(items.vertex(i));
            diagonal_[static_cast<std::size_t>(i)] = static_cast<float>(matrix.diagonal[vertex]);
            for (int k = 0; k < rows_.length(i); ++k) {
                const std::size_t entry = rows_.entry(i, k);
                const auto place = static_cast<std::size_t>(k);
                if (place < row.size()) {
                    others_[entry] = row[place].vertex;
                    weights_[entry] = static_cast<float>(row[place].value);
                } else {
                    others_[entry] = items.vertex(i);  // without weight
                }
            }
        }
    }

    SlicedRows rows_;
    Buffer<int> others_;
    Buffer<float> weights_;
    Buffer<float> diagonal_;
};

}  // namespace

Launch Hinges::project(const ProjectTarget& t) {
    return launch(kernels::project_hinges, elements().segments(t.phase), t.positions,
                  elements().vertices(), weights, *t.multipliers[0], count(), t.inverse_h2,
                  t.fresh);
}

std::unique_ptr<DerivativeRows> Hinges::make_rows(const VertexItems& items) {
    return std::make_unique<BendingRows>(*this, items);
}

Launch Hinges::energy_terms(const TermTarget& t) {
    return launch(kernels::hinge_terms, t.items, t.positions, elements().vertices(), weights,
                  t.slots, t.terms, count());
}

}  // namespace weft
