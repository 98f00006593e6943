#include "simulation/reference/incremental_potential.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "simulation/families/convert.h"

namespace weft {

namespace {

using Corners = std::array<Vec3, kMaxCorners>;
using Blocks = std::array<Mat3, kMaxCorners * kMaxCorners>;

Corners corners_of(const ElementFamily& family, int element, std::span<const Vec3> x) {
    Corners corners;
    const auto vertices = family.corners(element);
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        corners[k] = x[static_cast<std::size_t>(vertices[k])];
    }
    return corners;
}

using Whole = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor,
                            3 * kMaxCorners, 3 * kMaxCorners>;

Whole to_whole(const Blocks& blocks, std::size_t corners) {
    const auto size = static_cast<Eigen::Index>(3 * corners);
    Whole whole(size, size);
    for (Eigen::Index row = 0; row < size; ++row) {
        for (std::size_t k = 0; k < corners; ++k) {
            const auto j = static_cast<std::size_t>(row) / 3;
            const Vec3& part = blocks[j * corners + k].rows[static_cast<std::size_t>(row) % 3];
            whole.block<1, 3>(row, static_cast<Eigen::Index>(3 * k)) << part.x, part.y, part.z;
        }
    }
    return whole;
}

void from_whole(const Whole& whole, std::size_t corners, Blocks& blocks) {
    for (Eigen::Index row = 0; row < whole.rows(); ++row) {
        for (std::size_t k = 0; k < corners; ++k) {
            const auto j = static_cast<std::size_t>(row) / 3;
            const auto column = static_cast<Eigen::Index>(3 * k);
            blocks[j * corners + k].rows[static_cast<std::size_t>(row) % 3] = {
                whole(row, column), whole(row, column + 1), whole(row, column + 2)};
        }
    }
}

/// Leaves of an element's Hessian what its negative eigenvalues make: less that, it is the nearest
/// positive semi-definite one. False: it has none but by rounding, as most elements, for which it
/// is far cheaper to find that out than to find eigenvalues.
bool take_negative_part(Blocks& blocks, std::size_t corners) {
    constexpr double kRounding = 1e-13;
    const Whole whole = to_whole(blocks, corners);
    const double shift = kRounding * whole.cwiseAbs().diagonal().sum();
    const Whole lifted = whole + shift * Whole::Identity(whole.rows(), whole.rows());
    if (Eigen::LLT<Whole>(lifted).info() == Eigen::Success) return false;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(whole);
    const Eigen::VectorXd negative = solver.eigenvalues().cwiseMin(0.0);
    from_whole(solver.eigenvectors() * negative.asDiagonal() * solver.eigenvectors().transpose(),
               corners, blocks);
    return true;
}

}  // namespace

IncrementalPotential::IncrementalPotential(Model& model, double time,
                                           std::vector<FrozenContact> contacts)
    : families_(model.families), contacts_(std::move(contacts)) {
    const double h = model.h;
    const Vec3 gravity = model.scene.gravity_at(time + 0.5 * h);
    const auto count = static_cast<std::size_t>(model.vertex_count());
    predicted_.resize(count);
    inertia_.resize(count);
    for (std::size_t v = 0; v < count; ++v) {
        const float4& x = (*model.positions)[v];
        predicted_[v] = to_vec3(x);
        if (x.w <= 0.0f) continue;
        inertia_[v] = model.masses[v] / (h * h);
        predicted_[v] = predicted_[v] + h * (to_vec3((*model.velocities)[v]) + h * gravity);
    }
    if (model.moving_pins) model.moving_pins->place_at(time + h, predicted_);
    for (auto& family : model.families) family->place(time, h);
    make_pattern();
}

void IncrementalPotential::make_pattern() {
    std::vector<char> free(predicted_.size());
    for (std::size_t v = 0; v < free.size(); ++v) free[v] = is_free(static_cast<int>(v));
    std::vector<BlockMatrix::Group> groups;
    std::vector<Stencils> kinds;
    for (const auto& family : families_) kinds.push_back(family->elements().stencils());
    for (const Stencils& kind : kinds) {
        for (int e = 0; e < kind.count(); ++e) groups.push_back({kind[e]});
    }
    for (const FrozenContact& contact : contacts_) groups.push_back({contact.corners});
    exact_ = negative_ = hessian_ = BlockMatrix(free, groups);

    for (const auto& family : families_) {
        std::vector<int>& slots = slots_.emplace_back();
        for (int e = 0; e < family->count(); ++e) {
            const auto vertices = family->corners(e);
            for (const int row : vertices) {
                for (const int column : vertices) slots.push_back(exact_.find(row, column));
            }
        }
    }
    for (const FrozenContact& contact : contacts_) {
        for (const int row : contact.corners) {
            for (const int column : contact.corners) {
                contact_slots_.push_back(exact_.find(row, column));
            }
        }
    }
    for (std::size_t v = 0; v < free.size(); ++v) {
        diagonal_.push_back(exact_.find(static_cast<int>(v), static_cast<int>(v)));
    }
}

bool IncrementalPotential::rubs() const {
    return std::ranges::any_of(contacts_,
                               [](const FrozenContact& c) { return c.rubbing.friction > 0.0; });
}

void IncrementalPotential::press_as_at(std::span<const Vec3> x) {
    for (FrozenContact& contact : contacts_) contact.press = contact.force(contact.way(x));
    at_.clear();
}

double IncrementalPotential::energy(std::span<const Vec3> x) const {
    long double sum = 0.0L;
    for (std::size_t v = 0; v < predicted_.size(); ++v) {
        const Vec3 off = x[v] - predicted_[v];
        sum += 0.5 * inertia_[v] * dot(off, off);
    }
    for (const auto& family : families_) {
        for (int e = 0; e < family->count(); ++e) {
            sum += family->energy(e, corners_of(*family, e, x).data());
        }
    }
    for (const FrozenContact& contact : contacts_) sum += contact.energy(contact.way(x));
    return static_cast<double>(sum);
}

std::vector<Vec3> IncrementalPotential::gradient(std::span<const Vec3> x) const {
    std::vector<Vec3> sum(predicted_.size());
    for (const auto& family : families_) {
        for (int e = 0; e < family->count(); ++e) {
            Corners forces;
            family->gradient(e, corners_of(*family, e, x).data(), forces.data());
            const auto vertices = family->corners(e);
            for (std::size_t k = 0; k < vertices.size(); ++k) {
                Vec3& at = sum[static_cast<std::size_t>(vertices[k])];
                at = at + forces[k];
            }
        }
    }
    for (const FrozenContact& contact : contacts_) {
        const Vec3 pull = contact.gradient(contact.way(x));
        for (std::size_t k = 0; k < 4; ++k) {
            Vec3& at = sum[static_cast<std::size_t>(contact.corners[k])];
            at = at + contact.weights[k] * pull;
        }
    }
    for (std::size_t v = 0; v < sum.size(); ++v) {
        sum[v] =
            is_free(static_cast<int>(v)) ? sum[v] + inertia_[v] * (x[v] - predicted_[v]) : Vec3{};
    }
    return sum;
}

double IncrementalPotential::force_size(std::span<const Vec3> x) const {
    double size = 0.0;
    for (std::size_t v = 0; v < predicted_.size(); ++v) {
        size += inertia_[v] * length(x[v] - predicted_[v]);
    }
    for (const auto& family : families_) {
        for (int e = 0; e < family->count(); ++e) {
            Corners forces;
            family->gradient(e, corners_of(*family, e, x).data(), forces.data());
            const auto vertices = family->corners(e);
            for (std::size_t k = 0; k < vertices.size(); ++k) {
                if (is_free(vertices[k])) size += length(forces[k]);
            }
        }
    }
    for (const FrozenContact& contact : contacts_) {
        const double pull = length(contact.gradient(contact.way(x)));
        for (std::size_t k = 0; k < 4; ++k) {
            if (is_free(contact.corners[k])) size += pull * std::abs(contact.weights[k]);
        }
    }
    return size;
}

template <class Take>
void IncrementalPotential::sum_up(BlockMatrix& sum, Take take) const {
    sum.set_zero();
    for (std::size_t f = 0; f < families_.size(); ++f) {
        const ElementFamily& family = *families_[f];
        auto slot = slots_[f].begin();
        for (int e = 0; e < family.count(); ++e) {
            Blocks blocks;
            family.hessian(e, corners_of(family, e, at_).data(), blocks.data());
            const std::size_t corners = family.corners(e).size();
            const bool is_taken = take(blocks, corners);
            for (std::size_t b = 0; b < corners * corners; ++b, ++slot) {
                if (is_taken && *slot >= 0) sum.add(*slot, blocks[b]);
            }
        }
    }
}

const BlockMatrix& IncrementalPotential::hessian(std::span<const Vec3> x, double projection) {
    if (!std::ranges::equal(x, at_)) {
        at_.assign(x.begin(), x.end());
        sum_up(exact_, [](Blocks&, std::size_t) { return true; });
        for (std::size_t v = 0; v < predicted_.size(); ++v) {
            if (diagonal_[v] >= 0) exact_.add(diagonal_[v], inertia_[v] * Mat3{});
        }
        add_contacts();
        has_negative_ = false;
    }
    if (projection == 0.0) return exact_;
    if (!has_negative_) sum_up(negative_, take_negative_part);
    has_negative_ = true;
    hessian_.set_sum(exact_, -projection, negative_);
    return hessian_;
}

void IncrementalPotential::add_contacts() {
    auto slot = contact_slots_.begin();
    for (const FrozenContact& contact : contacts_) {
        const Mat3 hessian = contact.hessian(contact.way(at_));
        for (const double row : contact.weights) {
            for (const double column : contact.weights) {
                if (*slot >= 0) exact_.add(*slot, (row * column) * hessian);
                ++slot;
            }
        }
    }
}

}  // namespace weft
