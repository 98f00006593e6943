#pragma once

#include <array>
#include <vector>

#include "simulation/model/model.h"
#include "simulation/topology/vertex_layout.h"

namespace weft::test {

/// Vertex block descent once more (Chen et al. 2024): straightforward, in double precision, one
/// vertex after the other in the order that the layout defines. Shares the model's tables with the
/// solver, and no arithmetic. For a body that is held in one vertex, and whose obstacle, if it has
/// one, is a plane without friction that stands still, below cloth alone.
class ReferenceVbd {
public:
    explicit ReferenceVbd(const Model& model);

    /// One substep that ends at `time` + h.
    void substep(double time);

    std::vector<Vec3> x, v;  ///< new order [m], [m/s]

private:
    /// The quadratic model of the step's energy in one vertex.
    struct System {
        Vec3 gradient;
        std::array<Vec3, 3> hessian;  ///< rows

        /// Adds factor * direction direction^T.
        void add_dyad(double factor, Vec3 direction);
        void add_diagonal(double value);
        Vec3 solve(Vec3 force) const;  ///< hessian^-1 force
    };

    void begin(double time);
    System system_of(int vertex) const;
    void move(int vertex);
    void move_body();
    void add_spring(System& system, int spring, int vertex) const;
    void add_hinge(System& system, int hinge, int vertex) const;
    void add_membrane(System& system, int triangle, int vertex) const;
    void add_tetrahedron(System& system, int tetrahedron, int vertex) const;
    void shift_vertex(std::size_t i, Vec3 way);
    void push_out();
    Vec3 borne(const System& system, std::size_t vertex) const;
    void collide();

    const Model& model_;
    VertexLayout layout_;
    std::vector<double> mass_, decay_;  ///< mass 0: held
    std::vector<Vec3> start_, target_, deviation_;
    std::vector<bool> pushed_;  ///< in this substep
    /// Elements of each kind by vertex: springs, hinges, membranes, tetrahedra.
    std::array<std::vector<std::vector<int>>, 4> touching_;
};

}  // namespace weft::test
