#include "simulation/reference/coarse_level.h"

#include <array>

#include "simulation/reference/sparse_matrix.h"

namespace weft {

namespace {

/// Vertices of an aggregate: more of them make the factor cheaper and the iteration longer.
constexpr std::size_t kSize = 16;
/// Smaller ones join a neighbour.
constexpr std::size_t kLeast = 4;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

std::span<const int> neighbours(const BlockMatrix& a, int row) {
    const int begin = a.row_begin()[at(row)];
    return a.columns().subspan(at(begin), at(a.row_begin()[at(row) + 1] - begin));
}

}  // namespace

CoarseLevel::CoarseLevel(const BlockMatrix& a) : aggregate_(at(a.rows()), -1) {
    grow_aggregates(a);
    make_pattern(a);
}

/// Breadth-first from the first row that is in none yet.
void CoarseLevel::grow_aggregates(const BlockMatrix& a) {
    for (int seed = 0; seed < a.rows(); ++seed) {
        if (aggregate_[at(seed)] >= 0 || neighbours(a, seed).empty()) continue;
        std::vector<int> members{seed};
        aggregate_[at(seed)] = count_;
        int beside = -1;
        for (std::size_t next = 0; next < members.size(); ++next) {
            for (const int other : neighbours(a, members[next])) {
                int& place = aggregate_[at(other)];
                if (place >= 0 && place < count_) beside = place;
                if (place >= 0 || members.size() == kSize) continue;
                place = count_;
                members.push_back(other);
            }
        }
        if (members.size() < kLeast && beside >= 0) {
            for (const int v : members) aggregate_[at(v)] = beside;
        } else {
            ++count_;
        }
    }
}

void CoarseLevel::make_pattern(const BlockMatrix& a) {
    std::vector<std::array<int, 2>> pairs;
    for (int row = 0; row < a.rows(); ++row) {
        for (const int column : neighbours(a, row)) {
            pairs.push_back({aggregate_[at(row)], aggregate_[at(column)]});
        }
    }
    std::vector<BlockMatrix::Group> groups;
    for (const auto& pair : pairs) groups.push_back({pair});
    coarse_ = BlockMatrix(std::vector<char>(at(count_), 1), groups);
    slots_.reserve(pairs.size());
    for (const auto& [row, column] : pairs) slots_.push_back(coarse_.find(row, column));
}

bool CoarseLevel::factor(const BlockMatrix& a) {
    coarse_.set_zero();
    for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
        coarse_.add(slots_[slot], a.blocks()[slot]);
    }
    const auto lower = lower_triangle(coarse_);
    if (!is_analysed_) solver_.analyzePattern(lower);
    is_analysed_ = true;
    solver_.factorize(lower);
    return solver_.info() == Eigen::Success && (count_ == 0 || solver_.vectorD().minCoeff() > 0.0);
}

void CoarseLevel::add_solution(std::span<const Vec3> from, std::span<Vec3> to) const {
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(3 * count_);
    for (std::size_t v = 0; v < from.size(); ++v) {
        if (aggregate_[v] >= 0) sums.segment<3>(3 * aggregate_[v]) += to_eigen(from[v]);
    }
    const Eigen::VectorXd shifts = solver_.solve(sums);
    for (std::size_t v = 0; v < to.size(); ++v) {
        if (aggregate_[v] < 0) continue;
        const Eigen::Index k = 3 * aggregate_[v];
        to[v] = to[v] + Vec3{shifts[k], shifts[k + 1], shifts[k + 2]};
    }
}

}  // namespace weft
