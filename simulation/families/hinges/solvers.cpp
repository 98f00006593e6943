#include <algorithm>

#include "kernels/descent/hinges.h"
#include "kernels/xpbd/hinges.h"
#include "simulation/families/hinges/hinges.h"
#include "simulation/families/sliced_rows.h"

namespace weft {

namespace {

/// The matrix Q of E = 1/2 x^T Q x, row by row.
struct BendingMatrix {
    struct Weight {
        int vertex;
        double value;
    };
    std::vector<std::vector<Weight>> rows;  ///< [vertices] by ascending vertex, no diagonal
    std::vector<double> diagonal;           ///< [vertices]

    BendingMatrix(const Hinges& hinges, int vertex_count)
        : rows(static_cast<std::size_t>(vertex_count)),
          diagonal(static_cast<std::size_t>(vertex_count), 0.0) {
        for (int h = 0; h < hinges.count(); ++h) add(hinges, h);
        for (std::vector<Weight>& row : rows) merge(row);
    }

private:
    void add(const Hinges& hinges, int hinge) {
        const auto corners = hinges.corners(hinge);
        for (std::size_t j = 0; j < corners.size(); ++j) {
            const auto v = static_cast<std::size_t>(corners[j]);
            const double weight = hinges.weight(hinge, static_cast<int>(j));
            diagonal[v] += weight * weight;
            for (std::size_t k = 0; k < corners.size(); ++k) {
                if (k == j) continue;
                rows[v].push_back({corners[k], weight * hinges.weight(hinge, static_cast<int>(k))});
            }
        }
    }

    static void merge(std::vector<Weight>& row) {
        std::stable_sort(row.begin(), row.end(),
                         [](const Weight& a, const Weight& b) { return a.vertex < b.vertex; });
        std::vector<Weight> merged;
        for (const Weight& weight : row) {
            if (merged.empty() || merged.back().vertex != weight.vertex) {
                merged.push_back(weight);
            } else {
                merged.back().value += weight.value;
            }
        }
        row.swap(merged);
    }
};

std::vector<int> row_lengths(const BendingMatrix& matrix, const VertexItems& items) {
    std::vector<int> lengths;
    for (int i = 0; i < items.count(); ++i) {
        lengths.push_back(
            static_cast<int>(matrix.rows[static_cast<std::size_t>(items.vertex(i))].size()));
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
            const auto& row = matrix.rows[vertex];
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
