#pragma once

#include <memory>
#include <vector>

#include "runtime/step.h"
#include "simulation/model/model.h"

namespace weft {

/// Where the system is made, and where the last step started and led to (kernels/newton/springs.h).
struct LinearisedAt {
    Buffer<float4>& positions;
    Buffer<float4>& before;
    Buffer<float4>& after;
};

/// The gradient and the projected Hessian of one family of elements, the latter as blocks of
/// neighbouring vertices: per vertex a row of them. See kernels/newton/blocks.h.
class FamilyHessian {
public:
    /// items: item v is vertex v
    FamilyHessian(ElementFamily& family, const VertexItems& items, const Model& model);

    /// Adds the vertices' gradients to the sums.
    Launch gather_gradients(const DerivativeTarget& target);
    /// Makes the blocks anew.
    std::vector<Launch> couple(const LinearisedAt& where);
    /// Adds the vertices' own blocks to the Hessian's columns of `sums` (kernels/descent/rows.h),
    /// or puts them there where fresh is 1.
    Launch sum_rows(Buffer<float>& sums, int fresh);
    /// products += H directions, or, where fresh is 1, = H directions
    Launch multiply(Buffer<float4>& directions, Buffer<float>& products, int fresh);
    /// What a task over these strips needs of the blocks.
    void add_accesses(Step::Adding& task, int first_strip, int end_strip, bool writes);
    /// What couple() fills; null: nothing.
    BufferStorage* scratch() { return made_.get(); }

private:
    FamilyHessian(ElementFamily& family, const VertexItems& items, const Model& model,
                  const Couplings& couplings);
    BlockList place(const Couplings& couplings, const Strips& strips);
    void place_row(int v, const Couplings& couplings, BlockList& list);
    Buffer<float>& blocks() { return made_ ? *made_ : *contributions_->constant_blocks(); }

    int vertex_count_;
    int columns_;
    SlicedRows rows_;
    Buffer<int> others_;
    Buffer<int> entry_begin_;  ///< [strips + 1]
    Segments vertices_, entries_;
    std::unique_ptr<DerivativeRows> gradients_;  ///< null: they are H x
    std::unique_ptr<BlockRows> contributions_;
    std::unique_ptr<Buffer<float>> made_;  ///< [columns * entries] the blocks; null: constant ones
};

/// Those of all families.
class Hessian {
public:
    /// items: item v is vertex v
    Hessian(Model& model, VertexItems& items);

    /// sums: see kernels/descent/rows.h; writes the columns of the gradient
    std::vector<Launch> gather_gradients(Buffer<float4>& positions, Buffer<float>& sums);
    std::vector<Launch> couple(const LinearisedAt& where);
    std::vector<Launch> sum_rows(Buffer<float>& sums);
    std::vector<Launch> multiply(Buffer<float4>& directions, Buffer<float>& products);
    void add_accesses(Step::Adding& task, int first_strip, int end_strip, bool writes);
    /// What is made anew with each system.
    std::vector<BufferStorage*> scratch();

private:
    VertexItems& items_;
    std::vector<std::unique_ptr<FamilyHessian>> families_;
};

}  // namespace weft
