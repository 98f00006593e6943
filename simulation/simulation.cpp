#include "simulation/simulation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <numeric>

#include "runtime/clock.h"
#include "runtime/error.h"
#include "runtime/executor.h"
#include "runtime/tbb/cpu_device.h"
#include "simulation/diagnostics.h"
#include "simulation/output/state_hash.h"
#include "simulation/planning/frame_planner.h"
#include "simulation/planning/plan_log.h"
#include "simulation/planning/saved_costs.h"
#include "simulation/scene/mesh_files.h"

namespace weft {

namespace {

/// xyz of a buffer in scene order.
std::vector<float> in_scene_order(const Model& model, const Buffer<float4>& buffer) {
    std::vector<float> values(3 * buffer.count());
    for (std::size_t v = 0; v < buffer.count(); ++v) {
        float* to = &values[3 * static_cast<std::size_t>(model.strips.order[v])];
        to[0] = buffer[v].x;
        to[1] = buffer[v].y;
        to[2] = buffer[v].z;
    }
    return values;
}

std::uint32_t u32(int value) { return static_cast<std::uint32_t>(value); }

/// All tasks on processor 0, one after the other.
scheduler::Plan serial_plan(std::size_t task_count) {
    scheduler::Plan plan;
    for (std::size_t t = 0; t < task_count; ++t) {
        plan.placements.push_back({static_cast<double>(t), static_cast<double>(t + 1), 0});
    }
    return plan;
}

}  // namespace

Simulation::Simulation(const Scene& scene, const SimulationOptions& options, Warnings& warnings)
    : Simulation(scene, open_devices(options.devices, options.device_options), options, warnings) {}

Simulation::Simulation(const Scene& scene, std::vector<std::unique_ptr<Device>> devices,
                       const SimulationOptions& options, Warnings& warnings)
    : options_(options),
      devices_(std::move(devices)),
      active_(devices_.size()),
      model_(std::make_unique<Model>(scene, warnings)),
      solver_(make_solver(*model_)),
      plan_log_(std::make_unique<PlanLog>(devices_.size())) {
    std::iota(active_.begin(), active_.end(), 0);
    place();
    open_executor();
    if (options.calibrate) calibrate(restore_costs());
}

Simulation::~Simulation() = default;

Simulation::State Simulation::save() const {
    const auto copy = [](const Buffer<float4>& buffer) {
        return std::vector<float4>(buffer.data(), buffer.data() + buffer.count());
    };
    State state{copy(*model_->positions), copy(*model_->velocities), {}};
    for (const BufferStorage* buffer : solver_->state()) {
        const auto* bytes = static_cast<const std::byte*>(buffer->host());
        state.solver.emplace_back(bytes, bytes + buffer->bytes());
    }
    return state;
}

void Simulation::write(const State& state) {
    std::copy(state.positions.begin(), state.positions.end(), model_->positions->data());
    std::copy(state.velocities.begin(), state.velocities.end(), model_->velocities->data());
    const auto buffers = solver_->state();
    for (std::size_t b = 0; b < buffers.size(); ++b) {
        std::copy(state.solver[b].begin(), state.solver[b].end(),
                  static_cast<std::byte*>(buffers[b]->host()));
    }
}

void Simulation::restore(const State& state) {
    write(state);
    executor_->host_wrote(*model_->positions);
    executor_->host_wrote(*model_->velocities);
    for (BufferStorage* buffer : solver_->state()) executor_->host_wrote(*buffer);
}

Checkpoint Simulation::checkpoint() const {
    const auto bytes = [](const std::vector<float4>& values) {
        const auto* data = reinterpret_cast<const std::byte*>(values.data());
        return std::vector<std::byte>(data, data + values.size() * sizeof(float4));
    };
    State state = save();
    Checkpoint checkpoint{frame_, {bytes(state.positions), bytes(state.velocities)}};
    for (auto& buffer : state.solver) checkpoint.buffers.push_back(std::move(buffer));
    return checkpoint;
}

void Simulation::resume(const Checkpoint& checkpoint) {
    State state = save();
    std::vector<std::span<std::byte>> buffers{std::as_writable_bytes(std::span(state.positions)),
                                              std::as_writable_bytes(std::span(state.velocities))};
    for (auto& buffer : state.solver) buffers.emplace_back(buffer);
    const auto sizes_match = [](const auto& a, const auto& b) { return a.size() == b.size(); };
    if (!std::ranges::equal(buffers, checkpoint.buffers, sizes_match)) {
        throw UserError("the checkpoint is of another scene: its state has another size");
    }
    for (std::size_t b = 0; b < buffers.size(); ++b) {
        std::ranges::copy(checkpoint.buffers[b], buffers[b].begin());
    }
    frame_ = checkpoint.frame;
    place();
    restore(state);
}

void Simulation::start_from(int frame, std::span<const float> positions,
                            std::span<const float> velocities) {
    State state = save();
    for (std::size_t v = 0; v < state.positions.size(); ++v) {
        const std::size_t from = 3 * static_cast<std::size_t>(model_->strips.order[v]);
        float4& x = state.positions[v];
        float4& u = state.velocities[v];
        x = {positions[from], positions[from + 1], positions[from + 2], x.w};
        u = {velocities[from], velocities[from + 1], velocities[from + 2], u.w};
    }
    for (auto& bytes : state.solver) std::fill(bytes.begin(), bytes.end(), std::byte{});
    restore(state);
    frame_ = frame;
}

void Simulation::place() {
    model_->place(frame_time());
    if (!executor_) return;
    for (BufferStorage* buffer : model_->placed_buffers()) executor_->host_wrote(*buffer);
}

void Simulation::fetch() {
    executor_->fetch(*model_->positions);
    executor_->fetch(*model_->velocities);
    for (BufferStorage* buffer : solver_->state()) executor_->fetch(*buffer);
}

std::vector<Device*> Simulation::active_devices() const {
    std::vector<Device*> list;
    for (const int number : active_)
        list.push_back(devices_[static_cast<std::size_t>(number)].get());
    return list;
}

/// An executor and a planner for the devices that are there.
void Simulation::open_executor() {
    const auto bodies = solver_->bodies();
    const double epoch = executor_ ? executor_->epoch() : now();
    executor_.reset();
    executor_ = std::make_unique<Executor>(active_devices(), bodies, epoch);
    const bool all = active_.size() == devices_.size();
    planner_ =
        std::make_unique<FramePlanner>(*solver_, model_->strips.count(), active_devices(),
                                       options_.plan, all ? options_.division : std::nullopt);
}

bool Simulation::restore_costs() {
    if (options_.cost_file.empty()) return false;
    const SavedCosts saved(options_.cost_file);
    if (!saved.restore(solver_->bodies(), active_devices(), options_.device_options.strict_math,
                       planner_->timing())) {
        return false;
    }
    planner_->balance_mixture();
    return true;
}

void Simulation::save_costs() const {
    constexpr int kEnoughFrames = 5;  // the first ones are no rule
    if (options_.cost_file.empty() || frame_ < kEnoughFrames) return;
    SavedCosts saved(options_.cost_file);
    saved.save(solver_->bodies(), active_devices(), options_.device_options.strict_math,
               planner_->timing());
}

/// Profiles every device on the scene's own tasks; a substep or two each, undone afterwards.
/// costs_known: only what compiles, loads and pages in is left to do.
void Simulation::calibrate(bool costs_known) {
    const State start = save();
    const int instances = std::min(model_->scene.substeps, 2);
    const int rounds = costs_known ? 1 : 2;
    for (int round = 0; round < rounds; ++round) {
        for (const FramePlan& plan : planner_->calibration()) {
            const RunTimes times = executor_->run(*plan.step, plan.plan, instances);
            if (!costs_known) planner_->learn(plan, times, instances);
            restore(start);
        }
    }
}

FrameRecord Simulation::advance() {
    const State start = save();
    while (true) {
        try {
            return advance_from(start);
        } catch (const DeviceLost& lost) {
            go_on_without(lost, start);
        }
    }
}

/// The state in the middle of a frame is lost with the device, so the frame begins again.
void Simulation::go_on_without(const DeviceLost& lost, const State& start) {
    const int number = active_[static_cast<std::size_t>(lost.device)];
    const std::string name = devices_[static_cast<std::size_t>(number)]->info().name;
    losses_.push_back({number, frame_, lost.what()});
    active_.erase(active_.begin() + lost.device);
    write(start);
    if (active_.empty()) {
        throw RunError(fmt::format("device {} was lost in frame {}, and there is no other: {}",
                                   name, frame_, lost.what()));
    }
    std::vector<int> kept(active_.size());
    std::iota(kept.begin(), kept.end(), 0);
    for (int& k : kept) k += k >= lost.device ? 1 : 0;
    const TimingModel learnt = planner_->timing();
    open_executor();
    planner_->timing().inherit(learnt, kept);
    planner_->balance_mixture();
}

FrameRecord Simulation::advance_from(const State& start) {
    place();
    const FramePlan& plan = planner_->next();
    const int substeps = model_->scene.substeps;
    const RunTimes times = executor_->run(*plan.step, plan.plan, substeps);
    fetch();
    if (find_bad_state(*model_)) diagnose(start);
    FrameRecord frame = record(plan, times);
    planner_->learn(plan, times, substeps);
    ++frame_;
    return frame;
}

void Simulation::advance_by(const Step& step, const scheduler::Plan& plan) {
    const State start = save();
    place();
    executor_->run(step, plan, model_->scene.substeps);
    fetch();
    if (find_bad_state(*model_)) diagnose(start);
    ++frame_;
}

FrameRecord Simulation::record(const FramePlan& plan, const RunTimes& times) const {
    const int substeps = model_->scene.substeps;
    FrameRecord frame;
    frame.frame = u32(frame_);
    frame.sim_time = frame_time() + model_->scene.dt;
    frame.start = times.start - plan.plan_time;
    frame.end = times.end;
    frame.planned_makespan = plan.substep_time() * substeps;
    frame.measured_makespan = times.end - times.start;
    frame.lower_bound = plan.lower_bound() * substeps;
    frame.plan_time = plan.plan_time;
    plan_log_->record(plan, planner_->timing().costs(), active_, frame);

    const auto& tasks = plan.step->tasks();
    const auto number = [&](auto d) { return u32(active_[static_cast<std::size_t>(d)]); };
    frame.busy.resize(devices_.size(), 0.0);
    for (std::size_t d = 0; d < active_.size(); ++d) {
        double busy = 0.0;
        for (const TaskTime& t : times.tasks[d]) {
            busy += t.end - t.start;
            const auto items =
                static_cast<std::uint64_t>(tasks[static_cast<std::size_t>(t.task)].items);
            frame.executions.push_back(
                {u32(t.instance), u32(t.task), number(d), items, t.start, t.end});
        }
        frame.busy[number(d)] = busy;
    }
    for (const CopyRecord& copy : times.copies) {
        frame.transferred_bytes += copy.bytes;
        frame.transfers.push_back({u32(copy.instance), u32(copy.task), number(copy.from),
                                   number(copy.to), copy.bytes, copy.start, copy.end});
    }

    const Energies energies = measure_energies(*model_, frame.sim_time);
    frame.kinetic_energy = energies.kinetic;
    frame.gravity_energy = energies.gravity;
    frame.energies = energies.elements;
    return frame;
}

void Simulation::diagnose(const State& start) {
    // The same bits on every device: so this finds what happened there.
    restore(start);
    const auto device = make_cpu_device(1, {});
    const auto bodies = solver_->bodies();
    Executor executor({device.get()}, bodies);
    const Step step = solver_->make_step({});
    const auto fail = [&](int substep, const Task& task, const BadState& bad) {
        const std::string vertex = vertex_name(*model_, bad.vertex);
        restore(start);
        return RunError(
            fmt::format("the simulation diverged in frame {}, substep {}, seen after task '{}', "
                        "iteration {}: {}: "
                        "{}; smaller time steps (more substeps) or softer materials may help",
                        frame_, substep, task.body->name, task.iteration, vertex, bad.what));
    };
    for (int substep = 0; substep < model_->scene.substeps; ++substep) {
        for (const Task& task : step.tasks()) {
            Step one;
            one.add(task);
            executor.run(one, serial_plan(1), 1, substep);
            if (const auto bad = find_non_finite(*model_)) throw fail(substep, task, *bad);
        }
        // Only a substep's end is a state: before, positions may be far off for good reasons.
        if (const auto bad = find_bad_state(*model_))
            throw fail(substep, step.tasks().back(), *bad);
    }
    throw RunError(fmt::format("the simulation diverged in frame {}", frame_));
}

RunDescription Simulation::describe() const {
    const Scene& scene = model_->scene;
    RunDescription run;
    run.scene_name = scene.name;
    run.scene_text = scene.text;
    if (!scene.path.empty()) run.scene_path = std::filesystem::absolute(scene.path).string();
    for (const BodyMesh& mesh : mesh_files(scene)) {
        run.meshes.emplace_back(mesh.body, file_hash(mesh.path));
    }
    run.settings = {{"method", std::string(name_of(scene.solver.method))},
                    {"frames", std::to_string(scene.frames)},
                    {"dt", fmt::format("{}", scene.dt)},
                    {"substeps", std::to_string(scene.substeps)},
                    {"iterations", std::to_string(scene.solver.iterations)},
                    {"vertices", std::to_string(model_->vertex_count())},
                    {"strips", std::to_string(model_->strips.count())}};
    if (!scene.overrides.empty()) {
        run.settings.emplace_back("set", fmt::format("{}", fmt::join(scene.overrides, "\n")));
    }
    for (const auto& device : devices_) {
        const DeviceInfo& info = device->info();
        const bool host = info.memory == MemoryModel::kHost;
        run.devices.push_back({info.name, info.kind, info.driver, u32(info.units),
                               std::string(name_of(info.memory)), info.strict});
        if (!host && devices_.size() > 1) run.has_transfers = true;
    }
    run.kinds = solver_->kinds();
    run.energies = energy_names(*model_);
    return run;
}

std::vector<float> Simulation::positions() const {
    return in_scene_order(*model_, *model_->positions);
}
std::vector<float> Simulation::velocities() const {
    return in_scene_order(*model_, *model_->velocities);
}
std::string Simulation::hash() const { return state_hash(positions(), velocities()); }

}  // namespace weft
