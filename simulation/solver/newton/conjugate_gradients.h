#pragma once

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "simulation/solver/descent.h"
#include "simulation/solver/newton/coarse_space.h"
#include "simulation/solver/newton/contact_hessian.h"
#include "simulation/solver/newton/hessian.h"
#include "simulation/solver/newton/holds.h"

namespace weft {

/// Solves the linear system of a Newton step by so many steps of preconditioned conjugate
/// gradients; see kernels/newton/conjugate_gradients.h. What a step does, in tasks over strips:
///   correct:  the coarse space's answer to the residuals of all strips, and u = P r
///   product:  w = A u, with u of neighbouring strips (with contacts: of all); the strip's part of
///             both dot products
///   advance:  alpha and beta from those of all strips, and the vectors
class ConjugateGradients {
public:
    /// graph: of all elements of the model. control: of the iterations (kernels/newton/control.h)
    ConjugateGradients(Model& model, DescentSubstep& substep, const VertexGraph& graph,
                       Buffer<float>& control);

    /// Where the next system is made. Before the first one, `before` and `after` are to be x_t.
    LinearisedAt linearised_at() { return {*model_.positions, before_, after_}; }

    // The launches of each task.
    std::vector<Launch> linearise();
    std::vector<Launch> correct();
    std::vector<Launch> product();
    std::vector<Launch> advance();

    // What it needs over strips [first_strip, end_strip).
    void add_linearise_accesses(Step::Adding& task, int first_strip, int end_strip);
    void add_correct_accesses(Step::Adding& task, int first_strip, int end_strip);
    void add_product_accesses(Step::Adding& task, int first_strip, int end_strip);
    void add_advance_accesses(Step::Adding& task, int first_strip, int end_strip);

    /// What begin_conjugate_gradients and what comes after it make anew, and linearised_at().
    std::vector<BufferStorage*> scratch();

    CoarseSpace& coarse() { return coarse_; }
    /// Whose positions the derivatives of vertices [first, last) take.
    std::pair<int, int> around(int first, int last) const;
    const Halo& halo() const { return halo_; }
    /// [vertices] r and u, and [3 * vertices] column-major A u
    Buffer<float4>& residuals() { return residuals_; }
    Buffer<float4>& preconditioned() { return preconditioned_; }
    Buffer<float>& products() { return products_; }
    /// [3 * vertices] column-major: the solution
    Buffer<float>& moves() { return moves_; }
    /// [strips] see find_step
    Buffer<float4>& scalars() { return scalars_; }

private:
    static constexpr int kDotColumns = 32;
    void place_terms();
    void add_vectors(Step::Adding& task, int first, int last);
    /// [vertices] not read without holds
    Buffer<float4>& holds() { return holds_ ? holds_->holds() : residuals_; }
    int have_holds() const { return holds_ ? 1 : 0; }

    Model& model_;
    DescentSubstep& substep_;
    VertexItems items_;
    Buffer<float> sums_;  ///< [9 * vertices] see kernels/descent/rows.h
    Hessian hessian_;
    std::unique_ptr<ContactHessian> contacts_;  ///< null: none
    std::unique_ptr<NewtonHolds> holds_;        ///< null: nothing holds but pins
    CoarseSpace coarse_;
    Halo halo_;
    Buffer<float4> before_, after_;
    Buffer<float> factors_;
    Buffer<float4> residuals_, preconditioned_;
    Buffer<float> products_, searches_, applied_, moves_;
    Buffer<int> strip_of_;       ///< [vertices]
    Buffer<int> places_;         ///< [vertices] in terms_
    Buffer<int> columns_;        ///< [2 * 2 * kDotColumns * strips] see add_terms
    Buffer<int> column_begin_;   ///< [strips + 1]
    Buffer<int> strip_columns_;  ///< [strips] first of each
    Buffer<int> strip_begin_;    ///< [strips + 1] 0, 1, 2 ...: an item per strip
    std::unique_ptr<Buffer<float>> terms_;
    int delta_offset_ = 0;
    Buffer<float> column_sums_;
    Buffer<float> gammas_, deltas_;
    Buffer<float4> scalars_;
    Segments by_strip_, columns_by_strip_;
};

}  // namespace weft
