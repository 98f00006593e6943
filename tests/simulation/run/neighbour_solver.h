#pragma once

#include <memory>
#include <vector>

#include "simulation/solver/solver.h"

namespace weft::test {

/// Points that keep their distance: no elements, but a table of neighbours that is filled anew in
/// every substep, from all points of the scene.
class NeighbourSolver final : public Solver {
public:
    /// room: of the table's rows at the beginning
    NeighbourSolver(Model& model, float radius, int room);

    std::vector<const TaskBody*> bodies() const override {
        return {&predict_, &find_, &part_, &velocities_};
    }
    std::vector<std::string> kinds() const override {
        return {"predict", "find", "part", "velocities"};
    }
    std::vector<RowTable*> tables() override { return {&table_}; }
    Step make_step(const Partition& partition) override;

private:
    void add_find(Step& step, const Part& part, RegionId region);
    void add_part(Step& step, const Part& part, RegionId region);

    Model& model_;
    RowTable table_;
    Buffer<int> ranges_;  ///< [2 * vertices] all of them
    Buffer<int>& others_;
    Buffer<float>& squares_;
    TaskBody predict_, find_, part_, velocities_;
};

}  // namespace weft::test
