#include "simulation/solver/jpgd.h"

#include <algorithm>
#include <cmath>

#include "kernels/descent/substep.h"
#include "kernels/jpgd/contacts.h"
#include "kernels/jpgd/control.h"
#include "kernels/jpgd/step.h"
#include "simulation/solver/derivatives.h"
#include "simulation/solver/descent.h"
#include "simulation/solver/energy_sum.h"

namespace weft {

namespace {

enum Kind { kPredict, kEnergy, kDecide, kRevert, kRefresh, kStep, kVelocities, kKinds };

constexpr int kCheckEvery = 8;    ///< iterations
constexpr int kRefreshEvery = 8;  ///< iterations, from this one on; before it, every one
constexpr float kSlack = 1.00001f;
constexpr float kSlackWithPushes = 2.0f;  ///< by obstacles
/// Planes that take back what x~ leads through them do work as well. In collisions E rose by up to
/// 8 times on that; going back to the substep's start then threw away all that contacts had done.
constexpr float kSlackWithContacts = 16.0f;

/// Whether the blocks are taken anew. Wang and Yang 2016 do so every 32 iterations; but the first
/// iterations are those that bend and stretch, and blocks of springs at rest know nothing of what
/// holds a stretched one in its place across: steps by them overshoot, further in each iteration. A
/// pinned sheet got a thousand joules from nowhere (docs/solvers.md).
bool refreshes(int iteration) {
    return iteration < kRefreshEvery || iteration % kRefreshEvery == 0;
}

/// Wang and Yang 2016, section 4.3: the estimated spectral radius, in stages.
double spectral_radius(int iteration) {
    if (iteration < 1) return 0.0;
    if (iteration < 7) return 0.96;
    if (iteration < 10) return 0.991;
    return 0.999;
}

/// What of a mode is left after all iterations, it must not be below -1/3 (see control.h): with
/// this radius or less, Chebyshev's polynomial stays above -1/4.
double largest_radius(int iterations) { return 1.0 / std::cosh(std::acosh(4.0) / iterations); }

/// Chebyshev's weights: w_1 = 1, w_2 = 2 / (2 - rho^2), w_n = 4 / (4 - rho^2 w_(n-1)).
void fill_chebyshev(Buffer<float>& weights, int iterations) {
    double weight = 1.0;
    for (std::size_t n = 0; n < weights.count(); ++n) {
        const double rho =
            std::min(spectral_radius(static_cast<int>(n)), largest_radius(iterations));
        if (n == 1) weight = 2.0 / (2.0 - rho * rho);
        if (n > 1) weight = 4.0 / (4.0 - rho * rho * weight);
        weights[n] = static_cast<float>(weight);
    }
}

class JpgdSolver final : public Solver {
public:
    explicit JpgdSolver(Model& model)
        : model_(model),
          iterations_(model.scene.solver.iterations),
          substep_(model, BodyMomentum::Solves::kVertices, kKinds),
          contact_(substep_.contact()),
          items_(model.strips),
          derivatives_(model, items_),
          energy_(model, judged_from(), contact_ ? &contact_->energy() : nullptr),
          other_("positions.other", model.positions->count()),
          residues_{Buffer<float4>("positions.residue", model.positions->count()),
                    Buffer<float4>("positions.other.residue", model.positions->count())},
          kept_("positions.kept", model.positions->count()),
          control_("control", WEFT_CONTROL_SIZE),
          weights_("chebyshev", static_cast<std::size_t>(iterations_) + 1),
          first_strip_("first_strip", static_cast<std::size_t>(model.strips.count()) + 1) {
        fill_chebyshev(weights_, iterations_);
        std::fill(first_strip_.data() + 1, first_strip_.data() + first_strip_.count(), 1);
        if (model.obstacles) {
            kept_targets_ = std::make_unique<Buffer<float4>>("targets.kept", kept_.count());
        }
        make_bodies();
    }

    std::vector<const TaskBody*> bodies() const override {
        std::vector<const TaskBody*> list{&predict_, &decide_, &velocities_};
        for (const std::size_t parity : {0U, 1U}) {
            for (const auto* bodies : {&energies_, &reverts_, &refreshes_}) {
                list.push_back(&(*bodies)[parity]);
            }
            if (!contact_) list.push_back(&steps_[parity]);
        }
        substep_.list_bodies(list);
        return list;
    }
    std::vector<std::string> kinds() const override {
        std::vector<std::string> names{"predict", "energy", "decide",    "revert",
                                       "refresh", "step",   "velocities"};
        substep_.list_kinds(names);
        return names;
    }
    std::vector<BufferStorage*> state() override {
        auto buffers = substep_.state();
        buffers.push_back(&control_);
        return buffers;
    }
    std::vector<RowTable*> tables() override { return substep_.tables(); }
    ContactResponse* contact() override { return contact_; }

    std::vector<Buffer<float4>*> iterate() override { return {model_.positions.get(), &other_}; }

    /// Positions and what becomes of them take turns in two buffers. Behind a check, which may take
    /// back what was done, both have to be made anew before anybody may look at older ones.
    Asynchrony asynchrony() const override {
        if (substep_.has_narrow()) return {};  // as in sweeps.cpp
        return {{kRefresh, kStep}, {}, 0.5f, kCheckEvery, 2};
    }

    Step make_step(const Partition& partition) override {
        const auto regions = regions_of(partition);
        Step step;
        for (const Region& region : regions) substep_.add_begin(step, predict_, region);
        substep_.add_start(step, regions);
        substep_.add_first_narrow(step, regions);
        if (contact_ != nullptr) contact_->add_detection(step, regions);
        substep_.add_lead(step, regions);
        for (int i = 0; i < iterations_; ++i) {
            if (i % kCheckEvery == 0) add_check(step, regions, i);
            for (const Region& region : regions) {
                for_each_share(region,
                               [&](StripRange strips) { add_descent(step, i, strips, region.id); });
            }
            substep_.add_narrow(step, regions, i, static_cast<std::size_t>((i + 1) % 2));
        }
        add_check(step, regions, iterations_);
        substep_.add_last_narrow(step, regions, iterations_,
                                 static_cast<std::size_t>(iterations_ % 2));
        substep_.add_sums(step, regions, iterations_);
        for (const Region& region : regions) add_velocities(step, region);
        substep_.add_measurements(step, regions, iterations_);
        step.seal();
        return step;
    }

private:
    /// The positions after so many iterations.
    Buffer<float4>& after(int iterations) {
        return iterations % 2 == 0 ? *model_.positions : other_;
    }

    /// What is missing in them, see the step.
    Buffer<float4>& residue(int iterations) {
        return residues_[static_cast<std::size_t>(iterations % 2)];
    }

    void make_bodies() {
        predict_ = {"predict", kPredict, substep_.begin()};
        substep_.momentum().add_obstacles(predict_.launches, *model_.positions);
        const Segments first{&first_strip_, 0, 1, model_.strips.count()};
        decide_ = {"decide",
                   kDecide,
                   {launch(kernels::decide_step, first, control_, energy_.partials(),
                           static_cast<int>(energy_.partials().count()), slack(), kIteration)}};
        for (const int parity : {0, 1}) {
            const auto p = static_cast<std::size_t>(parity);
            energies_[p] = {"energy", kEnergy, energy_.launches(after(parity))};
            reverts_[p] = {"revert", kRevert, {keep_or_revert(after(parity), kept_)}};
            if (kept_targets_) {
                reverts_[p].launches.push_back(keep_or_revert(substep_.targets(), *kept_targets_));
            }
            refreshes_[p] = {"refresh", kRefresh, derivatives_.gather(kInnerPhase, after(parity))};
            steps_[p] = {"step", kStep, derivatives_.gather_gradients(kInnerPhase, after(parity))};
            if (contact_) {
                refreshes_[p].launches.push_back(bound_elements());
                refreshes_[p].launches.push_back(
                    contact_->gather_at(kInnerPhase, after(parity), items_, derivatives_.sums()));
            }
            for (TaskBody* body : {&refreshes_[p], &steps_[p]}) {
                if (substep_.momentum().solves_cloth()) {
                    body->launches.push_back(substep_.momentum().lead_cloth(
                        items_, kInnerPhase, after(parity), derivatives_.sums()));
                }
                body->launches.push_back(contact_ ? descend_beside_contacts(parity)
                                                  : descend(parity));
                substep_.momentum().add_obstacles(body->launches, after(parity + 1));
                if (contact_) add_truncation(body->launches, parity);
            }
        }
        substep_.momentum().look_at(after(iterations_));
        substep_.lead_tied_parts();
        substep_.lead_bodies();
        substep_.keep_triangles_out({&after(0), &after(1)}, /*snapshots=*/false);
        substep_.choose_starts({substep_.targets(),
                                items_,
                                derivatives_,
                                {kInnerPhase},
                                /*keeps_blocks=*/true,
                                halo_,
                                substep_.contact(),
                                /*solves_all=*/false});
        substep_.look_at_reactions(items_, derivatives_, {kInnerPhase}, after(iterations_),
                                   /*keeps_blocks=*/true);
        velocities_ = {"velocities", kVelocities, {}};
        if (iterations_ % 2 != 0) {
            velocities_.launches.push_back(
                launch(kernels::copy_positions, model_.vertices(), other_, *model_.positions));
        }
        const auto end = substep_.end();
        velocities_.launches.insert(velocities_.launches.end(), end.begin(), end.end());
    }

    /// What energies count inertia from. Reactions are forces of an obstacle, many times what
    /// inertia has: E has them no more than it has the obstacle, whose surface they do not leave.
    Buffer<float4>& judged_from() {
        BodyMomentum& momentum = substep_.momentum();
        return momentum.solves_cloth() ? *momentum.starts() : substep_.targets();
    }

    float slack() const {
        if (contact_) return kSlackWithContacts;
        return model_.obstacles ? kSlackWithPushes : kSlack;
    }

    Launch keep_or_revert(Buffer<float4>& values, Buffer<float4>& kept) {
        return launch(kernels::keep_or_revert, model_.vertices(), values, kept, control_);
    }

    Launch bound_elements() {
        return launch(kernels::bound_elements, model_.vertices(), derivatives_.sums(), control_,
                      items_.count());
    }

    Launch descend(int parity) {
        return launch(kernels::step_preconditioned, model_.vertices(), after(parity),
                      after(parity + 1), residue(parity), residue(parity + 1), substep_.targets(),
                      derivatives_.sums(), control_, weights_, items_.count(),
                      static_cast<float>(1.0 / (model_.h * model_.h)), kIteration);
    }

    Launch descend_beside_contacts(int parity) {
        return launch(kernels::step_beside_contacts, model_.vertices(), after(parity),
                      after(parity + 1), residue(parity), residue(parity + 1), substep_.targets(),
                      derivatives_.sums(), control_, weights_, contact_->counts(), items_.count(),
                      static_cast<float>(1.0 / (model_.h * model_.h)), kIteration);
    }

    void add_truncation(std::vector<Launch>& launches, int parity) {
        contact_->add_truncation(launches, after(parity + 1));
        launches.push_back(launch(kernels::drop_residues, model_.vertices(), contact_->cut(),
                                  residue(parity + 1)));
    }

    /// Contacts reach from anywhere to anywhere.
    std::pair<int, int> seen_from(int first, int last) const {
        return contact_ ? std::pair(0, model_.vertex_count()) : halo_.around(first, last);
    }

    void add_check(Step& step, const std::vector<Region>& regions, int iteration) {
        const auto parity = static_cast<std::size_t>(iteration % 2);
        const int columns = EnergySum::kColumns;
        for (const Region& region : regions) {
            const auto [first, last] = substep_.vertices(region.begin, region.end);
            const auto [seen_begin, seen_end] = seen_from(first, last);
            auto task = step.add(energies_[parity], iteration, region.strips(), region.id);
            task.reads(after(iteration), seen_begin, seen_end)
                .reads(judged_from(), first, last)
                .updates(energy_.partials(), columns * region.begin, columns * region.end);
            if (contact_) contact_->energy().add_terms_accesses(task, region.begin, region.end);
        }
        step.add(decide_, iteration, {0, 1})
            .reads(energy_.partials(), 0, columns * model_.strips.count())
            .updates(control_, 0, WEFT_CONTROL_SIZE);
        for (const Region& region : regions) {
            const auto [first, last] = substep_.vertices(region.begin, region.end);
            auto task = step.add(reverts_[parity], iteration, region.strips(), region.id);
            task.reads(control_, 0, WEFT_CONTROL_SIZE)
                .updates(after(iteration), first, last)
                .updates(kept_, first, last);
            if (!kept_targets_) continue;
            task.updates(substep_.targets(), first, last).updates(*kept_targets_, first, last);
        }
    }

    void add_descent(Step& step, int iteration, StripRange strips, RegionId region) {
        const bool is_fresh = contact_ || refreshes(iteration);
        const auto parity = static_cast<std::size_t>(iteration % 2);
        const auto [first, last] = substep_.vertices(strips.begin, strips.end);
        const auto [seen_begin, seen_end] = seen_from(first, last);
        auto task =
            step.add(is_fresh ? refreshes_[parity] : steps_[parity], iteration, strips, region);
        task.reads(control_, 0, WEFT_CONTROL_SIZE)
            .reads(after(iteration), seen_begin, seen_end)
            .reads(substep_.targets(), first, last)
            .updates(after(iteration + 1), first, last)
            .reads(residue(iteration), first, last)
            .updates(residue(iteration + 1), first, last);
        derivatives_.add_hessian_accesses(task, first, last, is_fresh);
        substep_.momentum().add_obstacle_accesses(task, first, last);
        substep_.momentum().add_cloth_accesses(task, first, last);
        if (!contact_) return;
        contact_->rows().add_reads(task, strips.begin, strips.end, first, last);
        contact_->add_truncation_accesses(task, strips);
    }

    /// Behind the last check, which is of iteration number `iterations_`.
    void add_velocities(Step& step, const Region& region) {
        auto task = substep_.add_end(step, velocities_, region, iterations_);
        if (iterations_ % 2 == 0) return;
        const auto [first, last] = substep_.vertices(region.begin, region.end);
        task.reads(other_, first, last).updates(*model_.positions, first, last);
    }

    Model& model_;
    int iterations_;
    DescentSubstep substep_;
    ContactResponse* contact_;  ///< null: none
    VertexItems items_;
    VertexDerivatives derivatives_;
    EnergySum energy_;
    Halo halo_{model_};
    Buffer<float4> other_;
    std::array<Buffer<float4>, 2> residues_;  ///< [parity of iterations]
    Buffer<float4> kept_;
    std::unique_ptr<Buffer<float4>> kept_targets_;  ///< null: no obstacles, nothing moves targets
    Buffer<float> control_;
    Buffer<float> weights_;
    Buffer<int> first_strip_;  ///< one item, in strip 0
    TaskBody predict_, decide_, velocities_;
    std::array<TaskBody, 2> energies_, reverts_, refreshes_, steps_;  ///< [parity of iterations]
};

}  // namespace

std::unique_ptr<Solver> make_jpgd_solver(Model& model) {
    return std::make_unique<JpgdSolver>(model);
}

}  // namespace weft
