#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "simulation/mesh/triangle_mesh.h"
#include "simulation/model/gathered.h"
#include "simulation/model/hinges.h"
#include "simulation/model/membranes.h"
#include "simulation/model/moving_pins.h"
#include "simulation/model/obstacles.h"
#include "simulation/model/springs.h"
#include "simulation/model/tetrahedra.h"
#include "simulation/scene/scene.h"

namespace weft {

/// A scene as buffers, in the order that strips and colours give it. Whatever the scene does not
/// name is not there. "Scene order" is the order of the meshes' vertices, cloth by cloth, then
/// solid by solid; "new order" is that of the buffers.
class Model {
public:
    /// Throws UserError for what is wrong with the scene's meshes, pins and attachments.
    Model(const Scene& scene, Warnings& warnings);

    int vertex_count() const { return static_cast<int>(strips.order.size()); }
    /// Fills in what moves by itself during the frame that begins at `time`.
    void place(double time);
    /// The buffers that place() writes.
    std::vector<BufferStorage*> placed_buffers();

    /// The vertices of each strip, as items.
    const Segments& vertices() const { return vertices_; }

    const Scene scene;
    const double h;  ///< one substep [s]

    // As the scene has it (scene order).
    std::vector<BodyRange> bodies;
    std::vector<std::array<int, 3>> triangles;  ///< of cloths all, of solids their surface
    std::vector<int> triangle_body;             ///< [triangles]

    // On the devices (new order).
    Strips strips;
    std::unique_ptr<Buffer<float4>> positions;  ///< xyz [m], w = 1/mass [1/kg], 0 for held vertices
    std::unique_ptr<Buffer<float4>> previous;   ///< xyz at the substep's start
    std::unique_ptr<Buffer<float4>> velocities;  ///< xyz [m/s], w = what damping leaves per substep
    std::unique_ptr<Buffer<float4>> gravity;     ///< [substeps] xyz [m/s^2]
    std::vector<double> masses;                  ///< [kg]; of held vertices, too
    bool damped = false;

    std::unique_ptr<Springs> springs;         ///< edges and attachments; null: neither
    std::unique_ptr<Membranes> membranes;     ///< null: no cloth has one
    std::unique_ptr<Hinges> hinges;           ///< null: no bending
    std::unique_ptr<Tetrahedra> tetrahedra;   ///< null: no solids
    std::unique_ptr<MovingPins> moving_pins;  ///< null: no pin moves
    std::unique_ptr<Obstacles> obstacles;     ///< null: none

private:
    void make_vertices(const Gathered& all);
    void make_elements(const Gathered& all);

    std::unique_ptr<Buffer<int>> strip_begin_;
    Segments vertices_;
};

}  // namespace weft
