#include "runtime/planning/row_items.h"

#include <algorithm>

namespace weft {

bool walks_rows(const TaskBody& body, RowTable& table) {
    return std::ranges::any_of(body.launches, [&](const Launch& launch) {
        return launch.segments.strip_count == table.items().strip_count &&
               std::ranges::any_of(launch.arguments, [&](const Argument& argument) {
                   return argument.buffer == &table.rows();
               });
    });
}

RowItems::RowItems(StepMaker& maker) : of_kind_(maker.kinds().size()) {
    for (RowTable* table : maker.tables()) {
        const auto strips = static_cast<std::size_t>(table->items().strip_count);
        rows_.push_back({table, std::vector<long>(strips + 1, 0)});
        for (const TaskBody* body : maker.bodies()) {
            auto& known = of_kind_[static_cast<std::size_t>(body->kind)];
            const bool is_known = !known.empty() && known.back() == rows_.size() - 1;
            if (!is_known && walks_rows(*body, *table)) known.push_back(rows_.size() - 1);
        }
    }
    note();
}

void RowItems::note() {
    for (Rows& rows : rows_) {
        const Segments& items = rows.table->items();
        const Buffer<int>& needs = rows.table->needs();
        for (int strip = 0; strip < items.strip_count; ++strip) {
            long count = rows.before[static_cast<std::size_t>(strip)];
            for (int i = items.item(strip); i < items.item(strip + 1); ++i) {
                count += needs[static_cast<std::size_t>(i)];
            }
            rows.before[static_cast<std::size_t>(strip) + 1] = count;
        }
    }
}

bool RowItems::vary(int kind) const {
    return !of_kind_.empty() && !of_kind_[static_cast<std::size_t>(kind)].empty();
}

double RowItems::of(const Task& task) const {
    long items = task.items;
    if (of_kind_.empty()) return static_cast<double>(items);
    for (const std::size_t number : of_kind_[static_cast<std::size_t>(task.body->kind)]) {
        const auto& before = rows_[number].before;
        items += before[static_cast<std::size_t>(task.end_strip)] -
                 before[static_cast<std::size_t>(task.first_strip)];
    }
    return static_cast<double>(items);
}

}  // namespace weft
