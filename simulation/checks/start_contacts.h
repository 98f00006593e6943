#pragma once

#include <vector>

#include "simulation/mesh/crossings.h"
#include "simulation/model/model.h"

namespace weft {

/// What is done about bodies that cross at the start.
enum class OnCrossing {
    kStop,  ///< the scene is refused, with the pairs
    kWarn,  ///< they are told, and the run goes on
};

/// Where a state is not what contact goes out from: surfaces apart from each other.
struct StartContacts {
    std::vector<TrianglePair> crossings;  ///< of the model's triangles, ascending
    /// A body, or a piece of one, that lies wholly inside of another one.
    struct Swallowed {
        int body, inside;  ///< of the model's
        int vertex;        ///< of the body, in scene order
    };
    std::vector<Swallowed> swallowed;
    /// Triangles that lie upon another body, to which all of their corners are tied: there is no
    /// room for contact between them, and edges of the two may cross.
    std::vector<int> overlaid;
    /// Nearer to each other than contact keeps surfaces apart.
    std::vector<TrianglePair> near;
    double least = 0.0;  ///< [m] distance of those
};

/// Of a model whose scene has [contact]; pairs that contact does not look at (tied to each other,
/// both held, of one body without contact.self) do not count.
/// floor  [m] that contact keeps surfaces apart
StartContacts find_start_contacts(const Model& model, double floor);

/// Throws UserError with the pairs that cross, or adds them to `warnings`, to which it adds the
/// near ones, too.
void check_start_contacts(const Model& model, OnCrossing on_crossing, Warnings& warnings);

}  // namespace weft
