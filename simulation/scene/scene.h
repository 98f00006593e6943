#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "runtime/io/compression.h"
#include "simulation/mesh/vec3.h"
#include "simulation/scene/element_settings.h"
#include "simulation/scene/method.h"
#include "simulation/scene/motion.h"

/// A whole scene as plain data. docs/scenes.md says what each value means to its author;
/// simulation/scene/keys.cpp is the one table of keys, ranges and defaults behind it.
///
/// SI units, y up. Whatever a scene does not name is absent here (empty optional or vector), and a
/// value that does nothing (damping 0, bend stiffness 0, friction 0, a motion at rest) counts as
/// not named: the program makes no task, kernel, buffer or dataset for what is absent.
namespace weft {

/// [solver]
struct SolverSettings {
    Method method = Method::kXpbd;
    int iterations = 8;  ///< per substep, >= 1
    /// Relative error of a step that will do: fewer iterations where they reach it; 0: none.
    double tolerance = 0.0;
    int cg_steps = 40;  ///< newton: of conjugate gradients, per iteration, >= 1
    int sweeps = 2;     ///< newton: of vertex block descent, per iteration, >= 0
};

/// A flat sheet in the x-z plane, its centre at the origin. Vertex (i, k) has index
/// k * resolution[0] + i. Corner names: "x-z-", "x+z-", "x-z+", "x+z+".
struct GridShape {
    std::array<double, 2> size{};     ///< [m] along x and z
    std::array<int, 2> resolution{};  ///< vertices along x and z, >= 2
};

/// The open side of a cone around the y axis, its middle at the origin: the rough form of a skirt.
/// Vertex (i, k) has index k * resolution[0] + i; row k = 0 is the top rim.
struct CylinderShape {
    std::array<double, 2> radius{};   ///< [m] at the top and at the bottom
    double height = 0.0;              ///< [m]
    std::array<int, 2> resolution{};  ///< vertices around (>= 3) and from top to bottom (>= 2)
};

/// A block of tetrahedra, its centre at the origin. Vertex (i, j, k) has index
/// (k * resolution[1] + j) * resolution[0] + i. Corner names: "x-y-z-", "x+y-z-" ... "x+y+z+";
/// face names: "x-", "x+" ... "z+".
struct BlockShape {
    std::array<double, 3> size{};     ///< [m] along x, y and z
    std::array<int, 3> resolution{};  ///< vertices along x, y and z, >= 2
    /// A picture of its x-y side, rows from the top, all as long: only cells whose middle is in a
    /// '#' are there, and only their vertices, in the same order. Such a block has no names for
    /// corners and faces. Empty: all of it.
    std::vector<std::string> outline{};
};

/// Of cloth a Wavefront OBJ file, of a solid a Gmsh (.msh) or VTK (.vtk) file.
struct MeshFile {
    std::string path;     ///< already joined to the scene's folder
    std::string rest{};   ///< of cloth: its shape at rest, another such file; empty: the same
    std::string where{};  ///< in the scene file, for messages
};

struct Rotation {
    Vec3 axis;
    double degrees = 0.0;
};

/// Applied in this order: scale, the rotations one after the other, translate.
struct Transform {
    Vec3 scale{1.0, 1.0, 1.0};
    std::vector<Rotation> rotations;
    Vec3 translate;
};

/// A grid or cylinder of cloth, a block of a solid, or a file of either.
using Shape = std::variant<GridShape, CylinderShape, BlockShape, MeshFile>;

/// Springs along the edges of the triangles.
struct Stretch {
    double stiffness = 0.0;  ///< per edge [N/m]; 0: no springs
};

/// What an elastic material is made of.
struct Material {
    double young = 0.0;    ///< [Pa], > 0
    double poisson = 0.0;  ///< in (-1, 0.5)
};

/// The triangles as a thin sheet of material that resists stretch and shear in its plane.
struct Membrane {
    Material material;
    double thickness = 0.0;  ///< [m], > 0
};

/// Bending over every edge between two triangles.
struct Bend {
    double stiffness = 0.0;     ///< [J], > 0
    bool rest_is_flat = false;  ///< whatever the rest shape is
};

/// Axis-aligned box in world coordinates at time 0.
struct Box3 {
    Vec3 low;
    Vec3 high;
};

/// Some of a body's vertices: those that any of these names. See selected_vertices() in
/// selection.h.
struct Selection {
    std::vector<std::string> corners;  ///< of a grid or block
    std::vector<std::string> edges;    ///< of a grid of cloth: "x-", "x+", "z-", "z+"
    std::vector<std::string> rims;     ///< of a cylinder: "top", "bottom"
    std::vector<std::string> faces;    ///< of a block
    std::vector<std::string> parts;    ///< objects and groups of a cloth's OBJ file
    std::vector<int> vertices;
    std::vector<Box3> boxes;
    std::string where;  ///< "file:line:column", for messages
};

/// Vertices held in place, or carried along one motion.
struct PinGroup : Selection {
    std::optional<Motion> motion;  ///< absent: held still
};

/// [[seam]] of one cloth with weld = true: vertices of both sides that lie in one place are one.
struct Weld {
    Selection a, b;
    std::string where;  ///< "file:line:column", for messages
};

/// [[cloth]]
struct Cloth {
    std::string name;  ///< unique among the scene's cloths and solids
    Shape shape;
    Transform transform;
    double density = 0.0;  ///< [kg/m^2], > 0
    Stretch stretch;
    std::optional<Membrane> membrane;
    std::optional<Bend> bend;
    ElementSettings elements;       ///< of further families
    std::optional<double> damping;  ///< of velocities [1/s], > 0
    std::vector<PinGroup> pins;
    bool weld = false;        ///< of a mesh file: vertices of its border in one place are one
    std::vector<Weld> welds;  ///< its welded seams
    std::string where;        ///< "file:line:column", for messages
};

/// [[solid]]: tetrahedra of stable Neo-Hookean material.
struct Solid {
    std::string name;  ///< unique among the scene's cloths and solids
    Shape shape;
    Transform transform;
    double density = 0.0;  ///< [kg/m^3], > 0
    Material material;
    std::optional<double> damping;  ///< of velocities [1/s], > 0
    std::vector<PinGroup> pins;
    std::string where;  ///< "file:line:column", for messages
};

/// [[attachment]]: a spring from each selected vertex of one body to the nearest vertex of another.
/// Its rest length is the distance at time 0, so vertices in one place are tied together.
struct Attachment {
    std::string a;  ///< the body whose vertices are selected
    std::string b;  ///< the body that they are tied to
    Selection selected;
    double stiffness = 0.0;       ///< of each spring [N/m], > 0
    std::optional<double> reach;  ///< [m] vertices with nothing of b nearer than this stay free
    std::string where;            ///< "file:line:column", for messages
};

/// One of the two edges that a seam joins: those of a cloth's border vertices that are selected.
struct SeamSide {
    std::string cloth;
    Selection selected;
};

/// [[seam]]: stitches between two edges of one cloth or two, which are pulled together and then
/// hold. A welded one is a Weld of its cloth.
struct Seam {
    SeamSide a, b;
    double stiffness = 0.0;  ///< of each stitch [N/m], > 0
    double time = 0.0;       ///< until it is closed [s], > 0
    std::string where;       ///< "file:line:column", for messages
};

/// [[obstacle]]: a rigid body that moves as it is told and pushes cloth and solids out.
///
/// Every shape lives in its own local frame, so that a kernel for it is one signed distance.
/// obstacle_shapes.h is the list of shapes.
struct Obstacle {
    std::string name;                    ///< unique in its scene
    std::string shape;                   ///< as in obstacle_shapes.h
    std::array<double, 4> dimensions{};  ///< [m] as in kernels/obstacles/<shape>.h
    /// [m] from the deepest point inside to the surface: half the least width; infinite for planes.
    double half_width = std::numeric_limits<double>::infinity();
    Vec3 half_size;                  ///< [m] of its box around the local origin; 0 for planes
    Frame frame;                     ///< local to world at time 0
    std::optional<double> friction;  ///< Coulomb coefficient, > 0
    double thickness = 0.0;          ///< [m] cloth keeps this distance, >= 0
    std::optional<Motion> motion;

    /// Local to world at `time` [s].
    Frame frame_at(double time) const { return moved(frame, motion, time); }
};

/// [[obstacle]] of shape "mesh": a surface whose vertices move as they are told, and that cloth and
/// solids touch by [contact].
struct MeshObstacle {
    std::string name;  ///< unique among obstacles, cloths and solids
    Shape shape;       ///< a grid, a cylinder or an OBJ file
    Transform transform;
    std::optional<Motion> motion;
    /// Instead of a motion: OBJ files of the same vertices, "body_*.obj", or a dataset that has
    /// them all, "body.h5:/points"; empty: none. The n-th frame is where they are after n times
    /// frame_time, linear between, held behind the last.
    std::string frames;
    double frame_time = 0.0;  ///< [s], > 0
    std::string where;        ///< "file:line:column" of its frames, for messages
};

/// [contact]: bodies touch each other, and themselves.
struct Contact {
    bool self = true;  ///< a body with itself, too
    /// [m] between the middles of two surfaces: where they begin to push each other apart, > 0;
    /// 0: chosen by the meshes. In a Model's scene it is always chosen.
    double thickness = 0.0;
    std::optional<double> friction;  ///< Coulomb coefficient, > 0
    /// Of a contact, in units of the least m / h^2 + stiffness at rest of its vertices, > 0.
    double stiffness = 4.0;
    /// What nothing passes through, however little a step is solved. Only those who ask what the
    /// energy alone would do leave them out.
    bool planes = true;
};

/// [guard]: beyond either bound a state counts as exploded.
struct Guard {
    double max_speed = 1000.0;  ///< [m/s] of any vertex
    /// Of any edge of cloth and solids, |length / rest length - 1|.
    double max_strain = 100.0;
};

/// [output]: the geometry that a run leaves.
struct OutputSettings {
    int every = 1;  ///< frames, >= 1
    Compression compression = Compression::kFast;
};

/// Gravity at one time; linear between keys, held before the first and after the last.
struct GravityKey {
    double time = 0.0;  ///< [s]
    Vec3 gravity;       ///< [m/s^2]
};

struct Scene {
    // [scene]
    std::string name;
    int frames = 0;                        ///< >= 1
    double dt = 0.0;                       ///< one frame [s], > 0
    int substeps = 0;                      ///< per frame, >= 1; 0: as many as the model needs
    Vec3 gravity;                          ///< [m/s^2]; not used where gravity_keys is not empty
    std::vector<GravityKey> gravity_keys;  ///< by rising time; empty: constant gravity

    SolverSettings solver;
    Guard guard;
    OutputSettings output;
    std::vector<Cloth> cloths;
    std::vector<Solid> solids;
    std::vector<Attachment> attachments;
    std::vector<Seam> seams;
    std::vector<Obstacle> obstacles;
    std::vector<MeshObstacle> mesh_obstacles;  ///< only with contact
    std::optional<Contact> contact;

    // Where it came from, for traces and replays.
    std::string path;                    ///< as given; empty for a scene read from a string
    std::string text;                    ///< the file's own words
    std::vector<std::string> overrides;  ///< "table.key=value", in the order applied

    Vec3 gravity_at(double time) const;
};

}  // namespace weft
