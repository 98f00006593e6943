#include "kernels/descent/hinges.h"
#include "kernels/xpbd/hinges.h"
#include "runtime/tbb/parallel.h"
#include "simulation/families/couplings.h"
#include "simulation/families/hinges/hinges.h"
#include "simulation/families/sliced_rows.h"

namespace weft {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Of the matrix Q of E = 1/2 x^T Q x, for each vertex.
std::vector<double> diagonal_of(const Hinges& hinges, int vertex_count) {
    std::vector<double> diagonal(at(vertex_count), 0.0);
    for (int h = 0; h < hinges.count(); ++h) {
        const ElementCorners corners = hinges.corners(h);
        for (int j = 0; j < std::ssize(corners); ++j) {
            diagonal[at(corners[at(j)])] += hinges.weight(h, j) * hinges.weight(h, j);
        }
    }
    return diagonal;
}

/// Off the diagonal: that of two vertices.
double weight_of(const Hinges& hinges, std::span<const Coupling> couplings) {
    double sum = 0.0;
    for (const Coupling& c : couplings) {
        sum += hinges.weight(c.element, c.j) * hinges.weight(c.element, c.k);
    }
    return sum;
}

std::vector<int> row_lengths(const Couplings& couplings, const VertexItems& items) {
    std::vector<int> lengths(at(items.count()));
    for_each_block(items.count(), [&](int /*block*/, int begin, int end) {
        for (int i = begin; i < end; ++i) {
            lengths[at(i)] = couplings.other_count(items.vertex(i));
        }
    });
    return lengths;
}

class BendingRows final : public DerivativeRows {
public:
    BendingRows(const Hinges& hinges, const VertexItems& items)
        : BendingRows(hinges, items, Couplings(hinges.elements(), items.vertex_count())) {}

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
    BendingRows(const Hinges& hinges, const VertexItems& items, const Couplings& couplings)
        : rows_("bending.rows", items.segment_begin(), row_lengths(couplings, items)),
          others_("bending.others", static_cast<std::size_t>(rows_.entry_count())),
          weights_("bending.row_weights", others_.count()),
          diagonal_("bending.diagonal", static_cast<std::size_t>(items.count())) {
        const std::vector<double> diagonal = diagonal_of(hinges, items.vertex_count());
        for_each_block(items.count(), [&](int /*block*/, int begin, int end) {
            for (int i = begin; i < end; ++i) {
                const int vertex = items.vertex(i);
                diagonal_[at(i)] = static_cast<float>(diagonal[at(vertex)]);
                place(i, vertex, hinges, couplings);
            }
        });
    }

    void place(int item, int vertex, const Hinges& hinges, const Couplings& couplings) {
        int k = 0;
        couplings.for_each_other(vertex, [&](int other, std::span<const Coupling> own) {
            const std::size_t entry = rows_.entry(item, k++);
            others_[entry] = other;
            weights_[entry] = static_cast<float>(weight_of(hinges, own));
        });
        const int room = rows_.room(item);
        for (; k < room; ++k) others_[rows_.entry(item, k)] = vertex;  // no weight
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
