#include "simulation/run/live_model.h"

#include <algorithm>
#include <utility>

#include "simulation/contact/response.h"

namespace weft {

namespace {

void forget_substeps(SimulationState& state) {
    for (auto& bytes : state.solver) std::fill(bytes.begin(), bytes.end(), std::byte{});
}

}  // namespace

LiveModel::LiveModel(const Scene& scene, SolverMaker make_solver,
                     std::vector<std::string>& warnings)
    : make_solver_(std::move(make_solver)),
      model_(std::make_shared<Model>(scene, warnings)),
      solver_(make_solver_(*model_)) {}

void LiveModel::open(std::vector<std::unique_ptr<Device>> devices, PlanningOptions options) {
    planned_ = std::make_unique<PlannedExecutor>(*solver_, model_->strips.count(),
                                                 std::move(devices), std::move(options));
}

void LiveModel::calibrate(std::vector<std::string>& warnings) {
    const bool costs_known = planned_->restore_costs();
    const auto start = snapshot();
    const int instances = std::min(model_->scene.substeps, 2);
    planned_->calibrate(
        instances, costs_known, [&] { restore(*start); }, warnings);
}

void LiveModel::place(double time) {
    model_->place(time);
    if (contact() != nullptr) contact()->motion().place(time);
    if (planned_) show_placed();
}

void LiveModel::show_placed() {
    std::vector<BufferStorage*> buffers = model_->placed_buffers();
    if (contact() != nullptr) {
        for (BufferStorage* buffer : contact()->motion().placed_buffers()) {
            buffers.push_back(buffer);
        }
    }
    for (BufferStorage* buffer : buffers) executor().host_wrote(*buffer);
}

void LiveModel::fetch() {
    executor().fetch(*model_->positions);
    executor().fetch(*model_->velocities);
    for (BufferStorage* buffer : solver_->state()) executor().fetch(*buffer);
}

std::shared_ptr<const SimulationState> LiveModel::snapshot() const {
    if (!snapshot_) snapshot_ = snapshots_.take(*model_, *solver_);
    return snapshot_;
}

void LiveModel::restore(const SimulationState& state) {
    planned_->forget_entries();
    state.put(*model_, *solver_);
    snapshot_.reset();
    executor().host_wrote(*model_->positions);
    executor().host_wrote(*model_->velocities);
    for (BufferStorage* buffer : solver_->state()) executor().host_wrote(*buffer);
    if (contact() != nullptr) executor().host_wrote(contact()->forget());
}

void LiveModel::start_from(std::span<const float> positions, std::span<const float> velocities) {
    SimulationState state = *snapshot();
    model_->from_scene_order(positions, state.positions);
    model_->from_scene_order(velocities, state.velocities);
    forget_substeps(state);
    restore(state);
}

void LiveModel::begin_frame() {
    start_ = snapshot();
    snapshot_.reset();
}

void LiveModel::go_back_to_start() {
    restore(*start_);
    show_placed();
}

void LiveModel::go_on_without(const DeviceLost& lost, int frame) {
    start_->put(*model_, *solver_);
    planned_->go_on_without(lost, frame);
}

void LiveModel::set_steps(Steps steps, double time) {
    Scene scene = model_->scene;
    const bool has_other_length = steps.substeps != scene.substeps;
    if (!has_other_length && steps.iterations == scene.solver.iterations) return;
    scene.substeps = steps.substeps;
    scene.solver.iterations = steps.iterations;
    SimulationState state = *snapshot();
    if (has_other_length) forget_substeps(state);
    std::vector<std::string> said_already;
    auto model = std::make_shared<Model>(scene, said_already);
    for (std::size_t v = 0; v < state.velocities.size(); ++v) {
        state.velocities[v].w = (*model->velocities)[v].w;  // what damping leaves per substep
    }
    auto solver = make_solver_(*model);
    model_.swap(model);
    solver_.swap(solver);
    planned_->take_over(*solver_, model_->strips.count());  // while those before are there
    place(time);
    restore(state);
}

void LiveModel::set_solver(SolverMaker make_solver, PlanKind plan, double time) {
    make_solver_ = std::move(make_solver);
    const auto start = snapshot();
    auto solver = make_solver_(*model_);
    solver_.swap(solver);
    planned_->take_over(*solver_, model_->strips.count(), plan);  // while the one before is there
    place(time);
    restore(*start);
}

std::vector<FrozenContact> LiveModel::contacts() {
    if (contact() == nullptr) return {};
    for (BufferStorage* buffer : contact()->rows().buffers()) executor().fetch(*buffer);
    return with_corners(contact()->frozen(), model_->strips.order);
}

StoredInContacts LiveModel::stored_in_contacts() {
    if (contact() == nullptr) return {};
    executor().fetch(contact()->energy().energies());
    return contact()->energy().stored();
}

}  // namespace weft
