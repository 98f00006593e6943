#pragma once

#include <memory>
#include <span>
#include <vector>

#include "runtime/step.h"
#include "simulation/solver/newton/aggregates.h"
#include "simulation/solver/newton/hessian.h"

namespace weft {

/// What conjugate gradients' preconditioner knows of the whole: translations of aggregates, solved
/// for exactly. See kernels/newton/coarse.h.
class CoarseSpace {
public:
    CoarseSpace(Model& model, Aggregates aggregates);

    /// Inertia is that of these inverse masses (w) from now on; vertices of none take no part,
    /// besides those that the model holds.
    void hold(std::span<const float4> positions);

    /// To make it anew: the blocks of each strip's aggregates,
    std::vector<Launch> couple(const LinearisedAt& where);
    void add_couple_accesses(Step::Adding& task, int first_strip, int end_strip);
    /// then, by one item of the first strip, their factors,
    std::vector<Launch> factor();
    void add_factor_accesses(Step::Adding& task);
    /// then the inverse, strip by strip.
    std::vector<Launch> invert();
    void add_invert_accesses(Step::Adding& task, int first_strip, int end_strip);

    /// The sums over the aggregates of each strip,
    Launch restrict(Buffer<float4>& residuals);
    void add_restrict_accesses(Step::Adding& task, int first_strip, int end_strip);
    /// and, from those of all strips, what they move by.
    Launch correct();
    void add_correct_accesses(Step::Adding& task, int first_strip, int end_strip);

    Buffer<float4>& corrections() { return corrections_; }
    /// [vertices]
    Buffer<int>& aggregate_of() { return aggregate_of_; }

    const Aggregates& aggregates() const { return aggregates_; }

private:
    struct Pair {
        int a, b;  ///< b < a; a: what of it is tied to vertices in none
    };
    static std::vector<Pair> pairs_of(const Model& model, const Aggregates& aggregates);
    CoarseSpace(Model& model, Aggregates aggregates, const std::vector<Pair>& pairs);
    void fill_pairs(const Model& model, const std::vector<Pair>& pairs);
    void fill_members(const Model& model);
    void fill_places(const Model& model);
    void add_family(ElementFamily& family, const std::vector<Pair>& pairs);
    float inertia_of(double mass) const;
    int unknowns() const { return 3 * aggregates_.count(); }
    int inverse_begin(int strip) const { return 3 * unknowns() * aggregates_.per_strip * strip; }

    double h2_;  ///< [s^2]
    Aggregates aggregates_;
    int pair_count_;
    int width_;                     ///< of the band
    Buffer<int> strip_aggregates_;  ///< [strips + 1]
    Buffer<int> strip_pairs_;       ///< [strips + 1]
    Buffer<int> first_;             ///< one item, in strip 0
    Buffer<int> pairs_;             ///< see the kernels for these and the following
    Buffer<float> blocks_;
    Buffer<float> inertia_;
    Buffer<float> band_;
    Buffer<float> numbers_;
    Buffer<int> places_;
    Buffer<float> inverse_;
    Buffer<float4> restricted_;
    Buffer<float4> corrections_;
    Buffer<int> aggregate_of_;
    std::unique_ptr<SlicedRows> rows_;
    std::unique_ptr<Buffer<int>> members_;
    std::unique_ptr<Buffer<float>> shares_;
    std::vector<std::unique_ptr<BlockRows>> families_;
    Segments by_strip_, pairs_by_strip_, first_item_;
};

}  // namespace weft
