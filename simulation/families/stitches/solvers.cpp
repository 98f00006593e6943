#include "kernels/descent/stitches.h"
#include "kernels/xpbd/stitches.h"
#include "simulation/families/element_rows.h"
#include "simulation/families/stitches/stitches.h"

namespace weft {

namespace {

class StitchRows final : public DerivativeRows {
public:
    StitchRows(Stitches& stitches, const VertexItems& items)
        : rows_("stitches", stitches.elements(), items),
          material_("stitches.row_material", 3 * rows_.entries()),
          clock_(*stitches.clock) {
        rows_.fill(material_, [&](int stitch, int) {
            return FewNumbers{stitches.start(stitch), stitches.stiffness(stitch),
                              stitches.rate(stitch)};
        });
        rows_.filled();
    }

    Launch gather(const DerivativeTarget& t) override {
        return launch_over_rows(kernels::gather_stitches, t);
    }
    Launch gather_gradients(const DerivativeTarget& t) override {
        return launch_over_rows(kernels::gather_stitch_gradients, t);
    }

private:
    template <class Kernel>
    Launch launch_over_rows(Kernel kernel, const DerivativeTarget& t) {
        return launch(kernel, t.segments, t.positions, t.vertices, rows_.slices(), rows_.others(),
                      material_, clock_, t.sums, t.item_count, rows_.entry_count(),
                      SlicedRows::kStride, t.fresh, kInstance);
    }

    ElementRows rows_;
    Buffer<float> material_;
    Buffer<float>& clock_;
};

}  // namespace

Launch Stitches::project(const ProjectTarget& t) {
    return launch(kernels::project_stitches, elements().segments(t.phase), t.positions,
                  elements().vertices(), material, *clock, *t.multipliers[0], count(), t.inverse_h2,
                  t.fresh, kInstance);
}

std::unique_ptr<DerivativeRows> Stitches::make_rows(const VertexItems& items) {
    return std::make_unique<StitchRows>(*this, items);
}

Launch Stitches::energy_terms(const TermTarget& t) {
    return launch(kernels::stitch_terms, t.items, t.positions, elements().vertices(), material,
                  *clock, t.slots, t.terms, count(), kInstance);
}

}  // namespace weft
