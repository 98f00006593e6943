#include "kernels/descent/curved_hinges.h"
#include "kernels/xpbd/curved_hinges.h"
#include "simulation/families/curved_hinges/curved_hinges.h"
#include "simulation/families/element_rows.h"

namespace weft {

namespace {

class CurvedHingeRows final : public DerivativeRows {
public:
    CurvedHingeRows(const CurvedHinges& hinges, const VertexItems& items)
        : rows_("curved_hinges", hinges.elements(), items),
          weights_("curved_hinges.row_weights", 6 * rows_.entries()) {
        rows_.fill(weights_, [&](int hinge, int corner) {
            return FewNumbers(hinges.seen_from(hinge, corner));
        });
        rows_.filled();
    }

    Launch gather(const DerivativeTarget& t) override {
        return launch_over_rows(kernels::gather_curved_hinges, t);
    }
    Launch gather_gradients(const DerivativeTarget& t) override {
        return launch_over_rows(kernels::gather_curved_hinge_gradients, t);
    }

private:
    template <class Kernel>
    Launch launch_over_rows(Kernel kernel, const DerivativeTarget& t) {
        return launch(kernel, t.segments, t.positions, t.vertices, rows_.slices(), rows_.others(),
                      weights_, t.sums, t.item_count, rows_.entry_count(), SlicedRows::kStride,
                      t.fresh);
    }

    ElementRows rows_;
    Buffer<float> weights_;
};

}  // namespace

Launch CurvedHinges::project(const ProjectTarget& t) {
    return launch(kernels::project_curved_hinges, elements().segments(t.phase), t.positions,
                  elements().vertices(), weights, *t.multipliers[0], count(), t.inverse_h2,
                  t.fresh);
}

std::unique_ptr<DerivativeRows> CurvedHinges::make_rows(const VertexItems& items) {
    return std::make_unique<CurvedHingeRows>(*this, items);
}

Launch CurvedHinges::energy_terms(const TermTarget& t) {
    return launch(kernels::curved_hinge_terms, t.items, t.positions, elements().vertices(), weights,
                  t.slots, t.terms, count());
}

}  // namespace weft
