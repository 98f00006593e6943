#pragma once

#include <vector>

#include "runtime/planning/step_maker.h"

namespace weft {

/// Whether a task of this body walks or fills the table's rows: one of its launches gets them.
bool walks_rows(const TaskBody& body, RowTable& table);

/// What the cost model counts of tasks whose kernels walk rows that every step fills anew: their
/// items, and the entries that those rows wanted in the last frame. By the items alone, a task
/// that is many times as long as it was a few frames ago would look the same.
class RowItems {
public:
    RowItems() = default;
    explicit RowItems(StepMaker& maker);

    /// Notes what the rows of the last frame wanted; the tables' needs() must be the host's.
    void note();
    double of(const Task& task) const;
    /// Whether tasks of this kind have more than their own items.
    bool vary(int kind) const;
    /// Whether those of any kind have.
    bool any_vary() const { return !rows_.empty(); }

private:
    struct Rows {
        RowTable* table = nullptr;
        std::vector<long> before;  ///< [strips + 1] entries of the strips before
    };
    std::vector<Rows> rows_;
    std::vector<std::vector<std::size_t>> of_kind_;  ///< [kind] numbers in rows_
};

}  // namespace weft
