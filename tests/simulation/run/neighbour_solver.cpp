#include "tests/simulation/run/neighbour_solver.h"

#include "kernels/motion.h"
#include "kernels/neighbours.h"

namespace weft::test {

namespace {

enum Kind { kPredict, kFind, kPart, kVelocities };

constexpr std::size_t kNothingToSpare = 0;  ///< so that it grows more than once

}  // namespace

NeighbourSolver::NeighbourSolver(Model& model, float radius, int room)
    : model_(model),
      table_("neighbours", model.vertices(), room, kNothingToSpare),
      ranges_("ranges", 2 * static_cast<std::size_t>(model.vertex_count())),
      others_(table_.add_column<int>("others")),
      squares_(table_.add_column<float>("squares")) {
    for (std::size_t i = 1; i < ranges_.count(); i += 2) ranges_[i] = model.vertex_count();
    const auto h = static_cast<float>(model.h);
    const auto inverse_h = static_cast<float>(1.0 / model.h);
    predict_ = {"predict",
                kPredict,
                {launch(kernels::predict, model.vertices(), *model.positions, *model.previous,
                        *model.velocities, *model.gravity, h, kInstance)}};
    find_ = {"find",
             kFind,
             {launch(kernels::find_neighbours, model.vertices(), *model.previous, ranges_,
                     table_.rows(), table_.counts(), table_.needs(), others_, squares_,
                     model.vertex_count(), radius, kInstance)}};
    part_ = {"part",
             kPart,
             {launch(kernels::part_neighbours, model.vertices(), *model.positions, *model.previous,
                     table_.rows(), table_.counts(), others_, squares_, radius)}};
    velocities_ = {
        "velocities",
        kVelocities,
        {launch(kernels::update_velocities, model.vertices(), *model.positions, *model.previous,
                *model.velocities, *model.gravity, h, inverse_h, kInstance)}};
}

Step NeighbourSolver::make_step(const Partition& partition) {
    const int all = static_cast<int>(partition.parts.size());
    Step step;
    const auto for_each = [&](auto add) {
        for (int r = 0; r < all; ++r)
            add(partition.parts[static_cast<std::size_t>(r)], RegionId{r});
    };
    const auto vertices = [&](const Part& part) {
        return std::pair(model_.vertices().item(part.begin), model_.vertices().item(part.end));
    };
    for_each([&](const Part& part, RegionId region) {
        const auto [first, last] = vertices(part);
        step.add(predict_, 0, part.strips(), region)
            .reads(*model_.velocities, first, last)
            .updates(*model_.positions, first, last)
            .updates(*model_.previous, first, last);
    });
    for_each([&](const Part& part, RegionId region) { add_find(step, part, region); });
    for_each([&](const Part& part, RegionId region) { add_part(step, part, region); });
    for_each([&](const Part& part, RegionId region) {
        const auto [first, last] = vertices(part);
        step.add(velocities_, 0, part.strips(), region)
            .reads(*model_.positions, first, last)
            .reads(*model_.previous, first, last)
            .updates(*model_.velocities, first, last);
    });
    step.seal();
    return step;
}

void NeighbourSolver::add_find(Step& step, const Part& part, RegionId region) {
    const int first = model_.vertices().item(part.begin);
    const int last = model_.vertices().item(part.end);
    step.add(find_, 0, part.strips(), region)
        .reads(*model_.previous, 0, model_.vertex_count())
        .updates(table_.counts(), first, last)
        .updates(table_.needs(), first, last)
        .updates(others_, table_.entries())
        .updates(squares_, table_.entries());
}

void NeighbourSolver::add_part(Step& step, const Part& part, RegionId region) {
    const int first = model_.vertices().item(part.begin);
    const int last = model_.vertices().item(part.end);
    step.add(part_, 0, part.strips(), region)
        .updates(*model_.positions, first, last)
        .reads(*model_.previous, 0, model_.vertex_count())
        .reads(table_.counts(), first, last)
        .reads(others_, table_.entries())
        .reads(squares_, table_.entries());
}

}  // namespace weft::test
