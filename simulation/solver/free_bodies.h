#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "runtime/step.h"
#include "simulation/contact/body_columns.h"
#include "simulation/model/model.h"

namespace weft {

/// Keeps the momentum of bodies that nothing holds, whatever the sweeps left unfinished; see
/// kernels/descent/free_bodies.h. A body is what hangs together by elements, attachments included;
/// it is free where no vertex of it is held. Obstacles hold nothing: their pushes move x~, too.
class FreeBodies {
public:
    /// Null where every vertex is held, or alone.
    static std::unique_ptr<FreeBodies> of(const Model& model);

    /// Whether some vertices of the strips belong to a free body.
    bool reach_into(int first_strip, int end_strip) const;

    /// What adds up the lags of a region's strips,
    std::vector<Launch> sum(Buffer<float4>& positions, Buffer<float4>& targets);
    void add_sum_accesses(Step::Adding& task, int first_strip, int end_strip);
    /// and, when all strips have done so, what moves the vertices of a region's strips.
    /// deviations  [vertices] x - x~
    std::vector<Launch> shift(Model& model, Buffer<float4>& deviations);
    void add_shift_accesses(Step::Adding& task);

    // For sums of more than lags; see the kernels.
    struct Run {
        int body, strip, begin, end;  ///< vertices [begin, end)
    };
    const Run& run(int r) const { return runs_[static_cast<std::size_t>(r)]; }
    int run_count() const { return static_cast<int>(runs_.size()); }
    int most_runs() const { return most_runs_; }  ///< of one body
    int body_count() const { return body_count_; }
    int column_count() const;
    /// Those of strips [first_strip, end_strip).
    std::pair<int, int> runs_in(int first_strip, int end_strip) const;
    BodyColumns columns();
    /// Adds them up for each run, in so many parts.
    Launch add_columns(Buffer<float4>& partials, Buffer<float4>& lags, int parts, int lag_count);

private:
    FreeBodies(const Model& model, const std::vector<int>& bodies, std::vector<Run> runs);
    static std::vector<Run> runs_of(const Model& model, const std::vector<int>& bodies);
    void fill_strips(const Model& model);
    void fill_columns(const Model& model, const std::vector<int>& bodies);
    void fill_bodies();

    /// Where columns of one kind are, and where their sums belong: an item per run and part.
    struct Sums {
        Sums(const FreeBodies& bodies, int parts, int lag_count);
        int parts, lag_count;
        Buffer<int> begin;           ///< [strips + 1]
        Buffer<int> starts, places;  ///< [items] see the kernel
    };
    Sums& sums(int parts, int lag_count);

    std::vector<Run> runs_;
    int most_runs_ = 0;  ///< of one body
    int body_count_ = 0;
    Buffer<int> strip_runs_;     ///< [strips + 1]
    Buffer<int> strip_columns_;  ///< [strips + 1]
    Buffer<int> rows_;           ///< [2 * columns] see the kernels for these and the following
    Buffer<int> first_run_;      ///< [runs]
    Buffer<float> counts_;       ///< [runs]
    Buffer<int> run_of_;         ///< [vertices]
    Buffer<float4> partials_;    ///< [columns]
    Buffer<float4> lags_;        ///< [runs + most_runs]
    Buffer<float4> shifts_;      ///< [runs + 1]
    std::unique_ptr<Buffer<int>> members_;   ///< [entries]
    std::unique_ptr<Buffer<float>> shares_;  ///< [entries]
    std::vector<std::unique_ptr<Sums>> sums_;
    Segments runs_by_strip_, columns_by_strip_, vertices_;
};

}  // namespace weft
