#include "simulation/solver/part_columns.h"

#include "kernels/bodies/runs.h"

namespace weft {

PartColumns lay_in_columns(std::span<const std::size_t> sizes) {
    constexpr std::size_t kColumns = WEFT_RUN_COLUMNS;
    PartColumns columns;
    int element = 0;
    for (const std::size_t size : sizes) {
        const std::size_t rows = (size + kColumns - 1) / kColumns;
        for (std::size_t c = 0; c < kColumns; ++c) {
            columns.rows.push_back(static_cast<int>(columns.entries.size() + c));
            columns.rows.push_back(static_cast<int>(rows));
        }
        for (std::size_t k = 0; k < rows * kColumns; ++k) {
            columns.entries.push_back(k < size ? element++ : PartColumns::kFiller);
        }
    }
    return columns;
}

void fill_members(const PartColumns& columns, std::span<const int> vertices,
                  std::span<const double> shares, Buffer<int>& members,
                  Buffer<float>& member_shares) {
    for (std::size_t e = 0; e < columns.entries.size(); ++e) {
        const bool is_filler = columns.entries[e] == PartColumns::kFiller;
        const auto element = static_cast<std::size_t>(columns.entries[e]);
        members[e] = is_filler ? members[e - 1] : vertices[element];
        member_shares[e] = is_filler ? 0.0f : static_cast<float>(shares[element]);
    }
}

}  // namespace weft
