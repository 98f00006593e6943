#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/planning/regions.h"
#include "runtime/step.h"
#include "simulation/contact/response.h"
#include "simulation/model/model.h"
#include "simulation/solver/halo.h"

namespace weft {

/// What keeps triangles off narrow obstacles behind each iteration: tasks that find what vertices
/// are asked for, from where all three corners are, and behind those of all regions tasks that push
/// them (simulation/model/narrow_obstacles.h).
class NarrowTask {
public:
    /// What the solver has.
    struct Setting {
        /// [vertices] each; where the iterates are, in turn
        std::vector<Buffer<float4>*> iterates;
        Buffer<float4>* targets = nullptr;   ///< [vertices] x~, which pushes lead; null: none
        Buffer<float4>* pressing = nullptr;  ///< [vertices] what presses; null: nobody asks
        ContactResponse* contact = nullptr;  ///< that has the last word; null: none
        bool snapshots = false;              ///< for contacts, behind what they say
    };
    /// Null: the model has no such obstacle.
    /// first_kind: of two
    static std::unique_ptr<NarrowTask> of(Model& model, Setting setting, int first_kind);

    std::vector<std::string> kinds() const { return {finds_[0].name, pushes_[0].name}; }
    void list_bodies(std::vector<const TaskBody*>& bodies) const;
    /// Before the first iteration, of a solver that must not begin inside: contacts are not found
    /// yet, and say nothing.
    void add_first(Step& step, const std::vector<Region>& regions);
    /// Behind an iteration. iterate: where it ended
    void add(Step& step, const std::vector<Region>& regions, int iteration,
             std::size_t iterate = 0);
    /// Behind the last one, more of the same, as triangles push each other's corners; what that
    /// leaves within obstacles is noted (NarrowObstacles::depths()).
    void add_last(Step& step, const std::vector<Region>& regions, int iteration,
                  std::size_t iterate = 0);

private:
    NarrowTask(Model& model, Setting setting, int first_kind);
    std::vector<Launch> find(Buffer<float4>& positions, bool notes);
    std::vector<Launch> push(Buffer<float4>& positions);
    void add_last_word(std::vector<Launch>& launches, Buffer<float4>& positions);
    void add_find(Step& step, const TaskBody& body, const Region& region, int iteration,
                  std::size_t iterate);
    Step::Adding add_push(Step& step, const TaskBody& body, const Region& region, int iteration,
                          std::size_t iterate);

    Model& model_;
    Setting setting_;
    Halo halo_;
    std::vector<TaskBody> finds_, pushes_, notes_;  ///< [iterates]
    TaskBody first_push_;
};

}  // namespace weft
