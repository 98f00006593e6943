#include "simulation/solver/sweeps.h"

namespace weft {

SweepSolver::SweepSolver(Model& model)
    : model_(model),
      substep_(model, BodyMomentum::Solves::kVertices, kKinds),
      halo_(model),
      predict_{"predict", kPredict, substep_.begin()},
      velocities_{"velocities", kVelocities, substep_.end()} {
    if (substep_.momentum().solves_cloth()) {
        substep_.momentum().add_obstacles(predict_.launches, *model.positions);
    }
    substep_.momentum().look_at(*model.positions);
    substep_.lead_tied_parts();
    substep_.lead_bodies();
    substep_.keep_triangles_out({model.positions.get()}, /*snapshots=*/true);
}

void SweepSolver::add_sweep(const VertexLayout& layout,
                            const std::function<std::vector<Launch>(const SweepTarget&)>& solve) {
    Sweep& sweep = *sweeps_.emplace_back(std::make_unique<Sweep>(model_, layout));
    sweep.seams = {"seams", kSeams, {}};
    sweep.strips = {"strips", kStrips, {}};
    if (sweeps_.size() == 1) {
        substep_.choose_starts({substep_.targets(),
                                sweep.items,
                                sweep.derivatives,
                                {kSeamPhase, kInnerPhase},
                                /*keeps_blocks=*/false,
                                halo_,
                                substep_.contact(),
                                /*solves_all=*/false});
        substep_.look_at_reactions(sweep.items, sweep.derivatives, {kSeamPhase, kInnerPhase},
                                   *model_.positions);
    }
    ContactResponse* contact = substep_.contact();
    const auto inverse_h2 = static_cast<float>(1.0 / (model_.h * model_.h));
    for (const Phase phase : {kSeamPhase, kInnerPhase}) {
        TaskBody& body = phase == kSeamPhase ? sweep.seams : sweep.strips;
        body.launches = sweep.derivatives.gather(phase, *model_.positions);
        if (contact != nullptr) {
            body.launches.push_back(
                contact->gather(phase, *model_.positions, sweep.items, sweep.derivatives.sums()));
        }
        if (substep_.momentum().solves_cloth()) {
            body.launches.push_back(substep_.momentum().lead_cloth(
                sweep.items, phase, *model_.positions, sweep.derivatives.sums()));
        }
        for (Launch& launch : solve({phase, *model_.positions, sweep.items,
                                     sweep.derivatives.sums(), substep_.targets(), inverse_h2})) {
            body.launches.push_back(std::move(launch));
        }
        body.taking_turns = static_cast<int>(body.launches.size());
    }
    substep_.momentum().add_obstacles(sweep.strips.launches, *model_.positions);
    if (contact == nullptr) return;
    contact->add_truncation(sweep.strips.launches, *model_.positions,
                            model_.scene.solver.iterations - 1);
    contact->add_snapshot(sweep.strips.launches, *model_.positions);
}

std::vector<const TaskBody*> SweepSolver::bodies() const {
    std::vector<const TaskBody*> list{&predict_};
    for (const auto& sweep : sweeps_) {
        list.push_back(&sweep->seams);
        list.push_back(&sweep->strips);
    }
    list.push_back(&velocities_);
    substep_.list_bodies(list);
    return list;
}

std::vector<std::string> SweepSolver::kinds() const {
    std::vector<std::string> names{"predict", "seams", "strips", "velocities"};
    substep_.list_kinds(names);
    return names;
}

/// Obstacles push x~ along, which seams read. Of what may touch its own, a part knows what all see.
std::vector<Buffer<float4>*> SweepSolver::iterate() {
    std::vector<Buffer<float4>*> buffers{model_.positions.get()};
    if (model_.obstacles) buffers.push_back(&substep_.targets());
    if (substep_.contact() != nullptr) buffers.push_back(&substep_.contact()->snapshots());
    return buffers;
}

/// Triangles that narrow obstacles push reach into other parts.
Solver::Asynchrony SweepSolver::asynchrony() const {
    if (substep_.has_narrow()) return {};
    return {{kSeams, kStrips}, {}};
}

Step SweepSolver::make_step(const Partition& partition) {
    const auto regions = regions_of(partition);
    const int iterations = model_.scene.solver.iterations;
    Step step;
    for (const Region& region : regions) substep_.add_begin(step, predict_, region);
    substep_.add_start(step, regions);
    if (substep_.contact() != nullptr) substep_.contact()->add_detection(step, regions);
    substep_.add_lead(step, regions);
    for (int i = 0; i < iterations; ++i) {
        add_iteration(step, regions, i);
        substep_.add_narrow(step, regions, i);
    }
    substep_.add_last_narrow(step, regions, iterations - 1);
    substep_.add_sums(step, regions, iterations - 1);
    for (const Region& region : regions) {
        substep_.add_end(step, velocities_, region, iterations - 1);
    }
    substep_.add_measurements(step, regions, iterations - 1);
    step.seal();
    return step;
}

/// As XPBD's: seams first, then strips.
void SweepSolver::add_iteration(Step& step, const std::vector<Region>& regions, int iteration) {
    for (const Region& region : regions) {
        for_each_part(
            region, [&](StripRange seams) { add_seams(step, iteration, seams, region.id); },
            [&](StripRange strips) { add_strips(step, iteration, strips, region.id); });
    }
}

/// The vertices of a seam lie within its hull; their elements have vertices in both strips.
void SweepSolver::add_seams(Step& step, int iteration, StripRange seams, RegionId region) {
    const int first = model_.strips.seam_begin[static_cast<std::size_t>(seams.begin)];
    const int last = model_.strips.seam_end[static_cast<std::size_t>(seams.end - 1)];
    const auto [halo_begin, halo_end] = halo_.around(first, last);
    auto task = step.add(sweep(iteration).seams, iteration, seams, region);
    task.updates(*model_.positions, first, last)
        .reads(*model_.positions, halo_begin, first)
        .reads(*model_.positions, last, halo_end)
        .reads(substep_.targets(), first, last);
    substep_.momentum().add_cloth_accesses(task, first, last);
    if (substep_.contact() == nullptr) return;
    substep_.contact()->add_gather_accesses(task, iteration, seams.begin, seams.end + 1);
}

void SweepSolver::add_strips(Step& step, int iteration, StripRange strips, RegionId region) {
    const auto [first, last] = substep_.vertices(strips.begin, strips.end);
    auto task = step.add(sweep(iteration).strips, iteration, strips, region);
    task.updates(*model_.positions, first, last).reads(substep_.targets(), first, last);
    substep_.momentum().add_obstacle_accesses(task, first, last);
    substep_.momentum().add_cloth_accesses(task, first, last);
    ContactResponse* contact = substep_.contact();
    if (contact == nullptr) return;
    contact->add_gather_accesses(task, iteration, strips.begin, strips.end);
    contact->add_truncation_accesses(task, strips);
    contact->add_snapshot_accesses(task, iteration, strips.begin, strips.end);
}

}  // namespace weft
