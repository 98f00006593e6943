#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "simulation/bodies/body_range.h"
#include "simulation/element_families.h"
#include "simulation/families/family.h"
#include "simulation/mesh/rest_shape.h"
#include "simulation/mesh/tet_mesh.h"
#include "simulation/mesh/triangle_mesh.h"
#include "simulation/scene/scene.h"
#include "simulation/topology/adjacency.h"

namespace weft {

struct ClothPart {
    const Scene& scene;
    const Cloth& cloth;
    const TriangleMesh& mesh;
    const Adjacency& adjacency;  ///< the mesh's edges and hinges
    const RestShape& rest;
    int first_vertex;  ///< of the cloth, in scene order
};

struct SolidPart {
    const Solid& solid;
    const TetMesh& mesh;
    int first_vertex;
};

/// What a scene has besides its bodies.
struct ScenePart {
    const Scene& scene;
    std::span<const BodyRange> bodies;
    std::span<const Vec3> rest;  ///< [vertices] at time 0 [m]
};

/// Something that a scene does not name, and therefore does not cost anything.
struct Absence {
    std::string what;
    std::string why;
    bool has_kernels = true;  ///< the family's own: they are not used then
};

/// Gathers the elements of one family from a scene's bodies, and makes the family once the order of
/// the vertices is known.
class FamilyBuilder {
public:
    FamilyBuilder(FamilyNames names, int arity) : names_(std::move(names)), stencils_{arity, {}} {}
    virtual ~FamilyBuilder() = default;
    FamilyBuilder(const FamilyBuilder&) = delete;
    FamilyBuilder& operator=(const FamilyBuilder&) = delete;

    const FamilyNames& names() const { return names_; }

    // Called in the order of the scene; each adds elements, if there are any.
    virtual void add(const ClothPart& /*part*/) {}
    virtual void add(const SolidPart& /*part*/) {}
    virtual void add(const ScenePart& /*part*/) {}

    /// What has been added, in scene order.
    const Stencils& stencils() const { return stencils_; }
    /// Only where that is not empty. rest: [vertices] in scene order [m]
    virtual std::unique_ptr<ElementFamily> build(const Strips& strips,
                                                 std::span<const Vec3> rest) const = 0;

    /// Adds to each vertex what holds it back at rest from moving alone along a unit vector, where
    /// such elements bear by bending: the diagonal of the energy's second derivatives.
    /// rest, firmness: [vertices] in scene order [m, N/m]
    virtual void add_firmness(std::span<const Vec3> /*rest*/, Vec3 /*along*/,
                              std::span<double> /*firmness*/) const {}

    /// Adds to each vertex its share of what holds back where a cloth is stretched along a unit
    /// vector in its plane, and not across it: the energy's second derivative by that strain.
    /// rest, resistance: [vertices] in scene order [m, J]
    virtual void add_resistance(std::span<const Vec3> /*rest*/, Vec3 /*along*/,
                                std::span<double> /*resistance*/) const {}

    /// What of the family the scene leaves out. exists: the model has elements of it
    virtual std::vector<Absence> absences(const Scene& scene, bool exists) const = 0;

protected:
    /// Room for so many more elements, no more. Once per body, not for each element.
    void reserve(std::size_t count) {
        stencils_.vertices.reserve(stencils_.vertices.size() +
                                   count * static_cast<std::size_t>(stencils_.arity));
    }
    template <std::size_t arity>
    void append(const std::vector<std::array<int, arity>>& elements, int first_vertex) {
        reserve(elements.size());
        for (const auto& element : elements) {
            for (const int vertex : element) stencils_.vertices.push_back(vertex + first_vertex);
        }
    }
    void append(const Stencils& elements, int first_vertex) {
        reserve(static_cast<std::size_t>(elements.count()));
        for (const int vertex : elements.vertices) {
            stencils_.vertices.push_back(vertex + first_vertex);
        }
    }
    void append(std::span<const int> element, int first_vertex) {
        for (const int vertex : element) stencils_.vertices.push_back(vertex + first_vertex);
    }
    /// Gives every element without one this value: those that were just appended.
    template <class Value>
    void fill(std::vector<Value>& values, const Value& value) const {
        values.resize(static_cast<std::size_t>(stencils_.count()), value);
    }

private:
    FamilyNames names_;
    Stencils stencils_;
};

#define WEFT_DECLARE(name) std::unique_ptr<FamilyBuilder> make_##name##_builder();
WEFT_ELEMENT_FAMILIES(WEFT_DECLARE)
#undef WEFT_DECLARE

/// One of each, in the order of the list.
std::vector<std::unique_ptr<FamilyBuilder>> make_family_builders();

}  // namespace weft
