#pragma once

#include <functional>
#include <optional>
#include <string>

#include "simulation/checks/watch.h"
#include "simulation/contact/response.h"

namespace weft {

/// Says where vertices or triangles have not gone with an obstacle that pushes them: what is too
/// fast for its substeps passes through cloth so.
class InsideChecks {
public:
    /// Of a frame in which contact, which has the last word, has kept vertices from that; the host
    /// has the contact's insides and cuts.
    std::optional<Alarm> look(const Model& model, ContactResponse& contact);
    /// Of a frame whose iterations may not have been enough for triangles; the host has the depths.
    std::optional<Alarm> look(const Model& model, NarrowObstacles& narrow);
    /// The last alarm was told, and the run goes on: only what is plainly deeper is another one.
    void told() { told_ = deepest_; }

private:
    /// How deep a vertex, or what is around it, is in which obstacle.
    struct Depth {
        int obstacle = 0;
        double depth = 0.0;  ///< [m]; 0: not plainly within one
    };
    using Depths = std::function<Depth(std::size_t vertex)>;
    struct Inside;
    static Inside find_inside(const Model& model, const BodyRange& body, const Depths& depths);
    static Depth depth_of_triangles(const Model& model, NarrowObstacles& narrow,
                                    std::size_t vertex);
    /// what: of vertices; remedy: as of alarms
    std::optional<Alarm> look(const Model& model, const Depths& depths, const char* what,
                              const std::string& remedy);

    double deepest_ = 0.0;  ///< [m] of the last alarm
    double told_ = 0.0;     ///< [m]
};

}  // namespace weft
