#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "runtime/step.h"
#include "simulation/contact/body_columns.h"
#include "simulation/model/model.h"

namespace weft {

/// What each body's runs are; see kernels/bodies/runs.h.
struct BodyRuns {
    Buffer<int>& first;     ///< [runs] the first one of the same body
    Buffer<float>& counts;  ///< [runs] of that body's runs
    const Segments& by_strip;
};

/// What is summed up of each run, and where: part p of run r is number
/// p * part_stride + r * run_stride.
struct SumLayout {
    int parts, part_stride, run_stride;

    friend bool operator==(const SumLayout&, const SumLayout&) = default;
};

/// Whether vertices [begin, end) are of solids alone.
bool is_solid(const Model& model, int begin, int end);

/// The bodies that nothing holds, and how they are summed up (kernels/bodies/runs.h). A body is
/// what hangs together by elements, attachments included; it is free where no vertex of it is held.
/// Obstacles hold nothing: their pushes move x~, too.
class FreeBodies {
public:
    /// Null where every vertex is held, or alone.
    static std::unique_ptr<FreeBodies> of(const Model& model);

    /// What hangs together.
    struct Whole {
        int begin, end;  ///< vertices [begin, end)
        int origin;      ///< one of them: what it is seen from
    };
    /// Bodies of which some vertices are held, which count for nothing and do not move. One at
    /// least.
    FreeBodies(const Model& model, const std::vector<Whole>& wholes);

    /// What of each vertex is summed up.
    struct Counted {
        std::vector<int> numbers;    ///< [vertices] what kernels call it; -1: it does not count
        std::vector<double> shares;  ///< [vertices]
    };
    FreeBodies(const Model& model, const std::vector<Whole>& wholes, const Counted& counted);

    /// Whether some vertices of the strips belong to a free body.
    bool reach_into(int first_strip, int end_strip) const;

    struct Run {
        int body, strip, begin, end;  ///< vertices [begin, end)
        int origin;                   ///< vertex that the body is seen from
        bool is_solid;                ///< all of the body
    };
    const Run& run(int r) const { return runs_[static_cast<std::size_t>(r)]; }
    bool has_solids() const { return std::ranges::any_of(runs_, &Run::is_solid); }
    int run_count() const { return static_cast<int>(runs_.size()); }
    int most_runs() const { return most_runs_; }  ///< of one body
    int body_count() const { return body_count_; }
    int column_count() const;
    /// Those of strips [first_strip, end_strip).
    std::pair<int, int> runs_in(int first_strip, int end_strip) const;
    BodyColumns columns();
    BodyRuns runs() { return {first_run_, counts_, runs_by_strip_}; }
    /// [vertices] the last one plus 1 for those of no free body. Of of()'s alone.
    Buffer<int>& run_of_vertices() { return *run_of_; }
    /// Adds up columns for each run.
    Launch add_columns(Buffer<float4>& partials, Buffer<float4>& sums, const SumLayout& layout);

private:
    void fill_strips(const Model& model);
    void number_vertices(const Model& model);
    void fill_columns(const Counted& counted);
    void fill_bodies();

    /// Where columns of one kind are, and where their sums belong: an item per run and part.
    struct Sums {
        Sums(const FreeBodies& bodies, const SumLayout& kind);
        SumLayout layout;
        Buffer<int> begin;           ///< [strips + 1]
        Buffer<int> starts, places;  ///< [items] see the kernel
    };
    Sums& sums(const SumLayout& layout);

    std::vector<Run> runs_;
    int most_runs_ = 0;  ///< of one body
    int body_count_ = 0;
    Buffer<int> strip_runs_;     ///< [strips + 1]
    Buffer<int> strip_columns_;  ///< [strips + 1]
    Buffer<int> rows_;           ///< [2 * columns] see the kernels for these and the following
    Buffer<int> first_run_;      ///< [runs]
    Buffer<float> counts_;       ///< [runs]
    std::unique_ptr<Buffer<int>> run_of_;    ///< [vertices] null: some are held
    std::unique_ptr<Buffer<int>> members_;   ///< [entries]
    std::unique_ptr<Buffer<float>> shares_;  ///< [entries]
    std::vector<std::unique_ptr<Sums>> sums_;
    Segments runs_by_strip_, columns_by_strip_;
};

}  // namespace weft
