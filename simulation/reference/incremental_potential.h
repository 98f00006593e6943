#pragma once

#include <memory>
#include <span>
#include <vector>

#include "simulation/contact/frozen.h"
#include "simulation/model/model.h"
#include "simulation/reference/block_matrix.h"

namespace weft {

/// What one step of a model minimises, in double precision:
///
///   E(x) = sum_v m_v / (2 h^2) |x_v - x~_v|^2 + sum of the energies of elements and contacts,
///   x~ = x_t + h v_t + h^2 g
///
/// with the vertices that are held where they are at the step's end. It is the same for all
/// solvers. Contacts are those that the step found where it began; friction has an energy only
/// where it is given what presses surfaces together (press_as_at). What is an inequality and no
/// energy is no part of it: contact with obstacles, and the planes that keep surfaces apart
/// (kernels/contact/truncation.h). Nor is damping: it takes its part of the velocities after the
/// step.
///
/// All vectors are [vertices], in the new order.
class IncrementalPotential {
public:
    /// The step that begins at `time` [s] from the model's positions and velocities, which are read
    /// now. Places the model's families for it (ElementFamily::place). The model must outlive this
    /// object; its elements are read whenever they are needed.
    /// contacts: that the step begins with
    IncrementalPotential(Model& model, double time, std::vector<FrozenContact> contacts = {});

    /// x~, and the held vertices' places.
    const std::vector<Vec3>& predicted() const { return predicted_; }
    bool is_free(int vertex) const { return inertia_[static_cast<std::size_t>(vertex)] > 0.0; }
    /// m / h^2 [N/m], 0 for held vertices.
    const std::vector<double>& inertia() const { return inertia_; }
    const std::vector<Owned<ElementFamily>>& families() const { return families_; }
    const std::vector<FrozenContact>& contacts() const { return contacts_; }
    /// Whether there is friction.
    bool rubs() const;
    /// From now on friction goes by what presses contacts together at x. At first nothing does.
    void press_as_at(std::span<const Vec3> x);

    /// [J]
    double energy(std::span<const Vec3> x) const;
    /// dE/dx [N], 0 for held vertices.
    std::vector<Vec3> gradient(std::span<const Vec3> x) const;
    /// What the gradient's rounding is measured by: the sum over vertices of the sizes of the
    /// forces that meet there [N], inertia included.
    double force_size(std::span<const Vec3> x) const;

    /// d2E/dx2 [N/m] of the free vertices; valid until the next call.
    /// projection: how much of the elements' negative curvature is taken away. 0: the exact
    /// Hessian; 1: the sum of positive semi-definite ones; between them, a mixture.
    const BlockMatrix& hessian(std::span<const Vec3> x, double projection);

private:
    void make_pattern();
    template <class Take>
    void sum_up(BlockMatrix& sum, Take take) const;
    /// To the exact one; they are positive semi-definite as they are.
    void add_contacts();

    const std::vector<Owned<ElementFamily>>& families_;  ///< the model's
    std::vector<FrozenContact> contacts_;
    std::vector<Vec3> predicted_;
    std::vector<double> inertia_;
    std::vector<Vec3> at_;  ///< where the Hessian was asked for last
    BlockMatrix exact_;     ///< there
    BlockMatrix negative_;  ///< the elements' negative curvature there, if has_negative_
    BlockMatrix hessian_;   ///< a mixture of both
    bool has_negative_ = false;
    std::vector<std::vector<int>> slots_;  ///< [family][element * corners^2], -1 where held
    std::vector<int> contact_slots_;       ///< [contact * 16], -1 where held
    std::vector<int> diagonal_;            ///< [vertices] slot, -1 where held
};

}  // namespace weft
