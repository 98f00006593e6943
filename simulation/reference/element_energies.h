#pragma once

#include <memory>
#include <span>
#include <vector>

#include "simulation/model/model.h"

namespace weft {

/// The most corners that an element has.
inline constexpr int kMaxCorners = 4;

/// The elements of one kind in double precision: the element functions of kernels/energies/,
/// compiled with real = double, on the material that the model's buffers hold.
class ElementEnergies {
public:
    virtual ~ElementEnergies() = default;

    virtual int count() const = 0;
    /// Its vertices, in the new order.
    virtual std::span<const int> corners(int element) const = 0;

    // x: the positions of the element's corners [m].

    /// [J]
    virtual double energy(int element, const Vec3* x) const = 0;
    /// dE/dx of each corner [N]
    virtual void gradient(int element, const Vec3* x, Vec3* gradient) const = 0;
    /// d2E/dx_jdx_k [N/m] as blocks[j * corners + k]; the exact one, which may be indefinite.
    virtual void hessian(int element, const Vec3* x, Mat3* blocks) const = 0;
};

std::unique_ptr<ElementEnergies> make_spring_energies(const Springs& springs);
std::unique_ptr<ElementEnergies> make_membrane_energies(const Membranes& membranes);
std::unique_ptr<ElementEnergies> make_tetrahedron_energies(const Tetrahedra& tetrahedra);
std::unique_ptr<ElementEnergies> make_hinge_energies(const Hinges& hinges);

/// All that the model has. The model must outlive them.
std::vector<std::unique_ptr<ElementEnergies>> make_element_energies(const Model& model);

}  // namespace weft
