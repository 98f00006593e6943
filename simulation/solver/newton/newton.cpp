#include "simulation/solver/newton/newton.h"

#include <algorithm>

#include "kernels/descent/substep.h"
#include "kernels/newton/control.h"
#include "runtime/unused_memory.h"
#include "simulation/families/tetrahedra/tetrahedra.h"
#include "simulation/solver/accesses.h"
#include "simulation/solver/derivatives.h"
#include "simulation/solver/energy_sum.h"
#include "simulation/solver/newton/conjugate_gradients.h"
#include "simulation/solver/newton/refinement.h"
#include "simulation/solver/newton/smoother.h"

namespace weft {

namespace {

enum Kind {
    kPredict,
    kLinearise,
    kCoarse,
    kFactor,
    kInvert,
    kCorrect,
    kProduct,
    kAdvance,
    kMove,
    kSeams,
    kStrips,
    kEnergy,
    kDecide,
    kRevert,
    kVelocities,
    kKinds
};

constexpr int kCoarseEvery = 5;  ///< iterations
constexpr float kSlack = 1.00001f;
constexpr float kSlackWithPushes = 2.0f;  ///< by obstacles, or friction, which E does not count

class NewtonSolver final : public Solver, public NewtonRefinement {
public:
    explicit NewtonSolver(Model& model)
        : NewtonSolver(model, VertexGraph(model.vertex_count(), model.stencils())) {}

    /// graph: of all elements of the model
    NewtonSolver(Model& model, const VertexGraph& graph)
        : model_(model),
          iterations_(model.scene.solver.iterations),
          substep_(model, BodyMomentum::Solves::kAll, kKinds),
          contact_(substep_.contact()),
          control_("control", WEFT_CONTROL_SIZE),
          gradients_(model, substep_, graph, control_),
          smoother_(model, substep_, graph, {kSeams, kStrips}),
          energy_(model, substep_.targets(), contact_ ? &contact_->energy() : nullptr),
          kept_("positions.kept", model.positions->count()),
          first_strip_("first_strip", static_cast<std::size_t>(model.strips.count()) + 1) {
        std::fill(first_strip_.data() + 1, first_strip_.data() + first_strip_.count(), 1);
        if (model.obstacles) {
            kept_targets_ = std::make_unique<Buffer<float4>>("targets.kept", kept_.count());
        }
        make_bodies();
    }

    std::vector<const TaskBody*> bodies() const override {
        std::vector<const TaskBody*> list{
            &predict_,         &linearise_,   &couple_,  &factor_, &invert_,
            &correct_,         &product_,     &advance_, &move_,   &smoother_.seams,
            &smoother_.strips, &energy_body_, &decide_,  &revert_, &velocities_};
        substep_.list_bodies(list);
        return list;
    }
    std::vector<std::string> kinds() const override {
        std::vector<std::string> names{"predict", "linearise", "coarse",  "factor", "invert",
                                       "correct", "product",   "advance", "move",   "seams",
                                       "strips",  "energy",    "decide",  "revert", "velocities"};
        substep_.list_kinds(names);
        return names;
    }
    std::vector<BufferStorage*> state() override { return substep_.state(); }
    std::vector<RowTable*> tables() override { return substep_.tables(); }
    ContactResponse* contact() override { return contact_; }

    Step make_step(const Partition& partition) override {
        regions_ = regions_of(partition);
        Step step;
        for (const Region& region : regions_) add_predict(step, region);
        substep_.add_start(step, regions_);
        substep_.add_first_narrow(step, regions_);
        number_ = 0;
        if (contact_ != nullptr) contact_->add_detection(step, regions_);
        add_check(step);
        for (int i = 0; i < iterations_; ++i) add_iteration(step, i, steps_of(i));
        if (model_.scene.solver.sweeps > 0) add_sweep(step);
        substep_.add_last_narrow(step, regions_, number_);
        substep_.add_sums(step, regions_, number_);
        for (const Region& region : regions_) substep_.add_end(step, velocities_, region, number_);
        substep_.add_measurements(step, regions_, number_);
        step.seal();
        return step;
    }

    void begin(std::span<const float4> positions, std::span<const float4> targets,
               std::span<const FrozenContact> contacts) override {
        if (contact_ != nullptr) contact_->put(contacts, positions, targets);
        const auto [x, before, after] = gradients_.linearised_at();
        for (Buffer<float4>* buffer : {&x, &before, &after}) {
            std::ranges::copy(positions, buffer->data());
        }
        std::ranges::copy(targets, substep_.targets().data());
        gradients_.coarse().hold(positions);
    }

    std::span<const float4> positions() const override { return model_.positions->span(); }

    void rest() override {
        std::vector<BufferStorage*> buffers = gradients_.scratch();
        buffers.insert(buffers.end(), {&substep_.targets(), &smoother_.derivatives.sums(),
                                       &energy_.terms(), &kept_, model_.velocities.get()});
        for (BufferStorage* buffer : buffers) give_back(*buffer);
    }

    Step make_iteration(bool is_first, int gradient_steps) override {
        regions_ = regions_of(Partition::whole(model_.strips.count()));
        Step step;
        number_ = 0;
        if (is_first) add_check(step);
        add_iteration(step, is_first ? 0 : 1, gradient_steps);
        step.seal();
        return step;
    }

private:
    void make_bodies() {
        const auto [positions, before, after] = gradients_.linearised_at();
        predict_ = {"predict", kPredict, substep_.begin()};
        predict_.launches.push_back(copy(*model_.previous, before));
        predict_.launches.push_back(copy(*model_.previous, after));
        substep_.momentum().add_obstacles(predict_.launches, *model_.positions);
        linearise_ = {"linearise", kLinearise, gradients_.linearise()};
        couple_ = {"coarse", kCoarse, gradients_.coarse().couple(gradients_.linearised_at())};
        factor_ = {"factor", kFactor, gradients_.coarse().factor()};
        invert_ = {"invert", kInvert, gradients_.coarse().invert()};
        correct_ = {"correct", kCorrect, gradients_.correct()};
        product_ = {"product", kProduct, gradients_.product()};
        advance_ = {"advance", kAdvance, gradients_.advance()};
        make_control_bodies();
        substep_.momentum().look_at(*model_.positions);
        substep_.keep_triangles_out({model_.positions.get()}, /*snapshots=*/true);
        substep_.choose_starts({substep_.targets(),
                                smoother_.items,
                                smoother_.derivatives,
                                {kSeamPhase, kInnerPhase},
                                /*keeps_blocks=*/false,
                                gradients_.halo(),
                                substep_.contact(),
                                /*solves_all=*/true});
        substep_.look_at_reactions(smoother_.items, smoother_.derivatives,
                                   {kSeamPhase, kInnerPhase}, *model_.positions);
        velocities_ = {"velocities", kVelocities, substep_.end()};
    }

    void make_control_bodies() {
        const Segments first{&first_strip_, 0, 1, model_.strips.count()};
        const auto partials = static_cast<int>(energy_.partials().count());
        const auto [positions, before, after] = gradients_.linearised_at();
        move_ = {"move",
                 kMove,
                 {copy(positions, before),
                  launch(kernels::move_by_solution, model_.vertices(), before, gradients_.moves(),
                         control_, positions, model_.vertex_count()),
                  copy(positions, after)}};
        substep_.momentum().add_obstacles(move_.launches, *model_.positions);
        if (contact_ != nullptr) {
            contact_->add_truncation(move_.launches, *model_.positions);
            contact_->add_snapshot(move_.launches, *model_.positions);
        }
        energy_body_ = {"energy", kEnergy, energy_.launches(*model_.positions)};
        decide_ = {"decide",
                   kDecide,
                   {launch(kernels::decide_newton, first, control_, energy_.partials(), partials,
                           is_pushed() ? kSlackWithPushes : kSlack, kIteration)}};
        // The state comes last, and is what is kept; after a bad step the next system is that of
        // the state as it is.
        revert_ = {"revert",
                   kRevert,
                   {keep_or_revert(before, kept_), keep_or_revert(after, kept_),
                    keep_or_revert(positions, kept_)}};
        if (kept_targets_) {
            revert_.launches.push_back(keep_or_revert(substep_.targets(), *kept_targets_));
        }
        // For sweeps that come next.
        if (contact_ != nullptr) contact_->add_snapshot(revert_.launches, *model_.positions);
    }

    bool is_pushed() const {
        return model_.obstacles || (contact_ != nullptr && contact_->rubbing().friction > 0.0);
    }

    Launch copy(Buffer<float4>& from, Buffer<float4>& to) {
        return launch(kernels::copy_positions, model_.vertices(), from, to);
    }

    Launch keep_or_revert(Buffer<float4>& values, Buffer<float4>& kept) {
        return launch(kernels::keep_or_revert, model_.vertices(), values, kept, control_);
    }

    /// The last iterations take the most. Where the matrix costs as much as many steps, a few more
    /// of them are cheaper than another matrix.
    int steps_of(int iteration) const {
        const int most = model_.scene.solver.cg_steps;
        const int first = is_mostly_solid() ? most / 2 : most / 8;
        return iteration > 20 ? most : std::min(most, std::max(1, first) << iteration);
    }

    bool is_mostly_solid() const {
        const auto* tetrahedra = model_.find<Tetrahedra>();
        return tetrahedra != nullptr && tetrahedra->count() > model_.vertex_count();
    }

    void add_iteration(Step& step, int iteration, int gradient_steps) {
        ++number_;
        for (const Region& region : regions_) {
            auto task = step.add(linearise_, number_, region.strips(), region.id);
            gradients_.add_linearise_accesses(task, region.begin, region.end);
        }
        if (iteration % kCoarseEvery == 0) add_coarse(step);
        for (int i = 0; i < gradient_steps; ++i) add_gradient_step(step);
        add_move(step);
        for (int i = 0; i < model_.scene.solver.sweeps; ++i) add_sweep(step);
        ++number_;
        add_check(step);
    }

    void add_coarse(Step& step) {
        CoarseSpace& coarse = gradients_.coarse();
        for (const Region& region : regions_) {
            const auto [first, last] = substep_.vertices(region.begin, region.end);
            const auto [halo_begin, halo_end] = gradients_.halo().around(first, last);
            auto task = step.add(couple_, number_, region.strips(), region.id);
            const auto [positions, before, after] = gradients_.linearised_at();
            task.reads(positions, halo_begin, halo_end)
                .reads(before, halo_begin, halo_end)
                .reads(after, halo_begin, halo_end);
            coarse.add_couple_accesses(task, region.begin, region.end);
        }
        auto factor = step.add(factor_, number_, {0, 1});
        coarse.add_factor_accesses(factor);
        for (const Region& region : regions_) {
            auto task = step.add(invert_, number_, region.strips(), region.id);
            coarse.add_invert_accesses(task, region.begin, region.end);
        }
    }

    /// What others need comes first, and what needs others last.
    void add_gradient_step(Step& step) {
        ++number_;
        for (const Region& region : regions_) {
            for_each_share(region, [&](StripRange strips) {
                auto task = step.add(correct_, number_, strips, region.id);
                gradients_.add_correct_accesses(task, strips.begin, strips.end);
            });
        }
        for (const Region& region : regions_) {
            for_each_share_inside_first(region, [&](StripRange strips) {
                auto task = step.add(product_, number_, strips, region.id);
                gradients_.add_product_accesses(task, strips.begin, strips.end);
            });
        }
        for (const Region& region : regions_) {
            auto task = step.add(advance_, number_, region.strips(), region.id);
            gradients_.add_advance_accesses(task, region.begin, region.end);
        }
    }

    template <class Visit>
    static void for_each_share_inside_first(const Region& region, Visit visit) {
        std::vector<StripRange> shares;
        for_each_share(region, [&](StripRange strips) { shares.push_back(strips); });
        std::ranges::reverse(shares);
        for (const StripRange strips : shares) visit(strips);
    }

    void add_predict(Step& step, const Region& region) {
        const auto [first, last] = substep_.vertices(region.begin, region.end);
        const auto [positions, before, after] = gradients_.linearised_at();
        substep_.add_begin(step, predict_, region)
            .updates(before, first, last)
            .updates(after, first, last);
    }

    void add_move(Step& step) {
        ++number_;
        const auto [positions, before, after] = gradients_.linearised_at();
        for (const Region& region : regions_) {
            const auto [first, last] = substep_.vertices(region.begin, region.end);
            auto task = step.add(move_, number_, region.strips(), region.id);
            task.updates(positions, first, last)
                .updates(before, first, last)
                .updates(after, first, last)
                .reads(control_, 0, WEFT_CONTROL_SIZE);
            add_columns(task, gradients_.moves(), model_.vertex_count(), 3, first, last, false);
            add_last_word_accesses(task, region.strips());
        }
        substep_.add_narrow(step, regions_, number_);
    }

    /// Of obstacles, and of contacts.
    void add_last_word_accesses(Step::Adding& task, StripRange strips) {
        const auto [first, last] = substep_.vertices(strips.begin, strips.end);
        substep_.momentum().add_obstacle_accesses(task, first, last);
        if (contact_ == nullptr) return;
        contact_->add_truncation_accesses(task, strips);
        contact_->add_snapshot_accesses(task, number_, strips.begin, strips.end);
    }

    void add_sweep(Step& step) {
        ++number_;
        for (const Region& region : regions_) {
            for_each_part(
                region, [&](StripRange seams) { add_seams(step, seams, region.id); },
                [&](StripRange strips) {
                    const auto [first, last] = substep_.vertices(strips.begin, strips.end);
                    auto task = step.add(smoother_.strips, number_, strips, region.id);
                    task.updates(*model_.positions, first, last)
                        .reads(substep_.targets(), first, last);
                    add_last_word_accesses(task, strips);
                    if (contact_ != nullptr) {
                        contact_->add_gather_accesses(task, number_, strips.begin, strips.end);
                    }
                });
        }
        substep_.add_narrow(step, regions_, number_);
    }

    /// As in sweeps.cpp.
    void add_seams(Step& step, StripRange seams, RegionId region) {
        const int first = model_.strips.seam_begin[static_cast<std::size_t>(seams.begin)];
        const int last = model_.strips.seam_end[static_cast<std::size_t>(seams.end - 1)];
        const auto [halo_begin, halo_end] = gradients_.halo().around(first, last);
        auto task = step.add(smoother_.seams, number_, seams, region);
        task.updates(*model_.positions, first, last)
            .reads(*model_.positions, halo_begin, first)
            .reads(*model_.positions, last, halo_end)
            .reads(substep_.targets(), first, last);
        if (contact_ != nullptr)
            contact_->add_gather_accesses(task, number_, seams.begin, seams.end + 1);
    }

    void add_check(Step& step) {
        const auto [positions, before, after] = gradients_.linearised_at();
        const int columns = EnergySum::kColumns;
        for (const Region& region : regions_) {
            const auto [first, last] = substep_.vertices(region.begin, region.end);
            const auto [halo_begin, halo_end] = gradients_.around(first, last);
            auto task = step.add(energy_body_, number_, region.strips(), region.id);
            if (contact_) contact_->energy().add_terms_accesses(task, region.begin, region.end);
            task.reads(positions, halo_begin, halo_end)
                .reads(substep_.targets(), first, last)
                .updates(energy_.partials(), columns * region.begin, columns * region.end);
        }
        step.add(decide_, number_, {0, 1})
            .reads(energy_.partials(), 0, columns * model_.strips.count())
            .updates(control_, 0, WEFT_CONTROL_SIZE);
        for (const Region& region : regions_) {
            const auto [first, last] = substep_.vertices(region.begin, region.end);
            auto task = step.add(revert_, number_, region.strips(), region.id);
            task.reads(control_, 0, WEFT_CONTROL_SIZE).updates(kept_, first, last);
            if (contact_) contact_->add_snapshot_accesses(task, number_, region.begin, region.end);
            for (Buffer<float4>* buffer : {&positions, &before, &after}) {
                task.updates(*buffer, first, last);
            }
            if (!kept_targets_) continue;
            task.updates(substep_.targets(), first, last).updates(*kept_targets_, first, last);
        }
    }

    Model& model_;
    int iterations_;
    DescentSubstep substep_;
    ContactResponse* contact_;  ///< null: none
    Buffer<float> control_;
    ConjugateGradients gradients_;
    NewtonSmoother smoother_;
    EnergySum energy_;
    Buffer<float4> kept_;
    std::unique_ptr<Buffer<float4>> kept_targets_;  ///< null: no obstacles, nothing moves targets
    Buffer<int> first_strip_;                       ///< one item, in strip 0
    TaskBody predict_, linearise_, couple_, factor_, invert_, correct_, product_, advance_;
    TaskBody move_, energy_body_, decide_, revert_, velocities_;
    std::vector<Region> regions_;  ///< of the step that is made
    int number_ = 0;               ///< of its tasks; traces call it their iteration
};

}  // namespace

std::unique_ptr<Solver> make_newton_solver(Model& model) {
    return std::make_unique<NewtonSolver>(model);
}

std::unique_ptr<NewtonRefinement> make_newton_refinement(Model& model) {
    return std::make_unique<NewtonSolver>(model);
}

}  // namespace weft
