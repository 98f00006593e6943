#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "simulation/families/block_rows.h"
#include "simulation/families/elements.h"
#include "simulation/families/vertex_items.h"
#include "simulation/mesh/vec3.h"
#include "simulation/topology/stencil_layout.h"

/// What the rest of the simulation asks of a family of elements. Nobody outside a family's own
/// folder knows it by name: element_families.h has the list.
namespace weft {

struct FamilyNames {
    std::string name;    ///< of its folder, its buffers and its files of kernels: "hinges"
    std::string title;   ///< in messages: "bending"
    std::string energy;  ///< of its column in traces: "bend"
};

/// An edge of a body.
struct Edge {
    int a, b;     ///< vertices, new order
    double rest;  ///< its length at rest [m]
};

/// A spring that ties what may be two bodies, and belongs to neither.
struct Tie {
    double rest;       ///< its length at time 0 [m],
    double rate;       ///< of which it loses so much per second [1/s], until nothing is left
    double stiffness;  ///< [N/m]
};

/// A state that is no state: what is wrong with which vertex.
struct BadState {
    int vertex = 0;  ///< new order
    std::string what;
};

// ---- what the launches of the solvers work on ----

/// XPBD.
struct ProjectTarget {
    Phase phase;
    Buffer<float4>& positions;
    /// [constraints of the family] a buffer for each
    std::span<const std::unique_ptr<Buffer<float>>> multipliers;
    float inverse_h2;  ///< 1 / h^2 [1/s^2]
    int fresh;         ///< 1 in the first iteration of a substep: multipliers count as 0
};

/// Gradients and Hessian blocks of vertices.
struct DerivativeTarget {
    const Segments& segments;  ///< of the items
    Buffer<float4>& positions;
    Buffer<int>& vertices;  ///< of the items
    Buffer<float>& sums;    ///< [9 * items], see kernels/descent/rows.h
    int item_count = 0;
    int fresh = 0;  ///< 1: overwrites what stands in the sums
};

/// Block descent: the launches that move vertices.
struct SweepTarget {
    Phase phase;
    Buffer<float4>& positions;
    VertexItems& items;
    Buffer<float>& sums;  ///< of all elements, see kernels/descent/rows.h
    Buffer<float4>& targets;
    float inverse_h2;
};

/// The terms of the energy sum.
struct TermTarget {
    const Segments& items;
    Buffer<float4>& positions;
    Buffer<int>& slots;    ///< [elements] in `terms`
    Buffer<float>& terms;  ///< [J]
};

/// A family seen from the vertices: per vertex a row of the elements that touch it.
class DerivativeRows {
public:
    virtual ~DerivativeRows() = default;
    /// Adds the family's part of each vertex' gradient and Hessian block.
    virtual Launch gather(const DerivativeTarget& target) = 0;
    /// Only of the gradients.
    virtual Launch gather_gradients(const DerivativeTarget& target) = 0;
};

/// Blocks of the Hessian of two vertices, or two groups of them; see kernels/newton/blocks.h.
struct BlockTarget {
    const Segments& segments;  ///< of the blocks
    Buffer<float4>& positions;
    Buffer<float4>& before;  ///< where the last step started,
    Buffer<float4>& after;   ///< and where it led to; kernels/newton/springs.h
    Buffer<float>& blocks;   ///< [columns * block_count]
    int block_count = 0;
    int columns = 9;
    int fresh = 0;  ///< 1: overwrites what stands in the blocks
};

/// A family seen from such blocks: per block a row of what the elements contribute.
class BlockRows {
public:
    virtual ~BlockRows() = default;
    /// Launches that follow each other.
    virtual std::vector<Launch> couple(const BlockTarget& target) = 0;
    /// [blocks] What couple() writes where that is the same in every state, and a block is one
    /// number; null: it is not.
    virtual Buffer<float>* constant_blocks() { return nullptr; }
};

/// Elements whose vertices are computed together, in one sweep.
class StencilSolve {
public:
    virtual ~StencilSolve() = default;
    virtual Launch solve(const SweepTarget& target) = 0;
};

/// All elements of one kind that a model has, on the devices, and what solvers, reference and
/// diagnostics do with them.
class ElementFamily {
public:
    /// stencils: in the old order of vertices
    ElementFamily(const FamilyNames& names, const Stencils& stencils, const Strips& strips)
        : names_(names), elements_(names.name, stencils, strips) {}
    virtual ~ElementFamily() = default;
    ElementFamily(const ElementFamily&) = delete;
    ElementFamily& operator=(const ElementFamily&) = delete;

    const FamilyNames& names() const { return names_; }
    /// What there is of it, in words for users.
    virtual std::vector<std::string> parts() const { return {names_.title}; }
    Elements& elements() { return elements_; }
    const Elements& elements() const { return elements_; }
    int count() const { return elements_.count(); }
    /// The vertices of an element, in the new order.
    ElementCorners corners(int element) const { return elements_.vertices_of(element); }

    // ---- XPBD ----

    /// What to call the multipliers of the constraints that each element has; "" where it is one.
    virtual std::vector<std::string> constraints() const { return {""}; }
    virtual Launch project(const ProjectTarget& target) = 0;

    // ---- methods that descend the step's energy ----

    // What is made of a family launches on its tables, too, where these change.
    virtual std::unique_ptr<DerivativeRows> make_rows(const VertexItems& items) = 0;
    virtual Launch energy_terms(const TermTarget& target) = 0;
    /// How many numbers a block of the Hessian has: 1, 6 or 9 (kernels/newton/blocks.h).
    virtual int block_columns() const { return 9; }
    virtual std::unique_ptr<BlockRows> make_block_rows(const BlockList& list) = 0;
    /// Whether E = 1/2 x^T H x with the H of constant_blocks(): gradients are H x then.
    virtual bool is_quadratic() const { return false; }
    /// Whether elements may be stencils of SOSD; else their vertices belong to other stencils or
    /// are solved one by one.
    virtual bool has_stencils() const { return false; }
    /// Only where it has them. items: of the sweep; chosen: which elements are its stencils
    virtual std::unique_ptr<StencilSolve> make_stencils(const VertexLayout& items,
                                                        const StencilLayout::Family& chosen) const;

    /// Whether elements of two vertices bring these to one place in the end.
    virtual bool brings_together() const { return false; }

    // ---- what changes by itself ----

    /// Makes room for the substeps of a frame; before all else.
    virtual void reserve(int /*substeps*/) {}
    /// Fills in the frame that begins at `time` and has substeps of h [s]. In double precision, the
    /// end of its first substep counts.
    virtual void place(double /*time*/, double /*h*/) {}
    /// The buffer that place() writes; null: nothing changes.
    virtual BufferStorage* placed_buffer() { return nullptr; }

    // ---- in double precision ----
    // The element functions of kernels/energies/, compiled with real = double, on the material that
    // the buffers hold. x: the positions of the element's corners [m].

    /// [J]
    virtual double energy(int element, const Vec3* x) const = 0;
    /// Of elements [begin, end), added up as LaneSum does [J]; by sum_of_energies().
    virtual double sum_energies(int begin, int end, std::span<const float4> positions) const = 0;
    /// The same at a time [s], whatever place() was told; where nothing changes by itself, there is
    /// no difference.
    virtual double sum_energies_at(double /*time*/, int begin, int end,
                                   std::span<const float4> positions) const {
        return sum_energies(begin, end, positions);
    }
    /// dE/dx of each corner [N]
    virtual void gradient(int element, const Vec3* x, Vec3* gradient) const = 0;
    /// d2E/dx_jdx_k [N/m] as blocks[j * corners + k]; the exact one, which may be indefinite.
    virtual void hessian(int element, const Vec3* x, Mat3* blocks) const = 0;

    /// Of all elements [J], added up in blocks by as many threads as there are: always in the same
    /// order. positions: [vertices]
    double total_energy(std::span<const float4> positions) const;
    /// Of an element that is one.
    virtual std::optional<Tie> tie(int /*element*/) const { return std::nullopt; }
    /// Adds the edges of bodies that elements lie along; of elements that share one, each its own.
    virtual void add_edges(std::vector<Edge>& /*edges*/) const {}

    std::array<Vec3, kMaxCorners> positions_of(int element,
                                               std::span<const float4> positions) const;

protected:
    /// The edges of a triangle or tetrahedron whose rest edges from the first corner are the
    /// columns of the inverse of the matrix with rows b [1/m]. Of a triangle, b[2] is across.
    static void add_edges_of(std::span<const int> corners, const std::array<Vec3, 3>& b,
                             std::vector<Edge>& edges);

private:
    FamilyNames names_;
    Elements elements_;
};

}  // namespace weft
