#include "tests/simulation/run/manual_run.h"

#include <cstring>

#include "runtime/planning/planned_executor.h"
#include "runtime/tbb/cpu_device.h"
#include "simulation/contact/response.h"
#include "simulation/output/state_hash.h"

namespace weft::test {

namespace {

std::vector<std::unique_ptr<Device>> one_thread() {
    std::vector<std::unique_ptr<Device>> devices;
    devices.push_back(make_cpu_device(1, {}));
    return devices;
}

}  // namespace

ManualRun::ManualRun(const Scene& scene) : ManualRun(scene, one_thread()) {}

ManualRun::ManualRun(const Scene& scene, std::vector<std::unique_ptr<Device>> devices)
    : devices_(std::move(devices)) {
    Warnings warnings;
    model = std::make_unique<Model>(scene, warnings);
    solver = make_solver(*model);
    model->place(0.0);
    const auto values = [](const Buffer<float4>& b) {
        return std::vector<float4>(b.span().begin(), b.span().end());
    };
    first_positions_ = values(*model->positions);
    first_velocities_ = values(*model->velocities);
    std::vector<Device*> pointers;
    for (const auto& device : devices_) pointers.push_back(device.get());
    executor_ = std::make_unique<Executor>(pointers, solver->bodies());
}

void ManualRun::reset() {
    std::copy(first_positions_.begin(), first_positions_.end(), model->positions->data());
    std::copy(first_velocities_.begin(), first_velocities_.end(), model->velocities->data());
    changed(*model->positions);
    changed(*model->velocities);
    for (BufferStorage* buffer : solver->state()) {
        std::memset(buffer->host(), 0, buffer->bytes());
        changed(*buffer);
    }
    frame_ = 0;
}

void ManualRun::run(int frames, const Division& division) {
    for (int f = 0; f < frames; ++f) run_frame(division, model->scene.substeps);
}

void ManualRun::run_substeps(int substeps) {
    run_frame(Division::single(device_count(), strip_count(), 0), substeps);
}

void ManualRun::run_frame(const Division& division, int substeps) {
    model->place(frame_ * model->scene.dt);
    if (auto* contact = solver->contact()) contact->motion().place(frame_ * model->scene.dt);
    hand_over_placed();
    std::vector<std::vector<std::byte>> before;
    for (BufferStorage* buffer : state()) {
        const auto* bytes = static_cast<const std::byte*>(buffer->host());
        before.emplace_back(bytes, bytes + buffer->bytes());
    }
    run_step(division, substeps);
    while (grow_tables(solver->tables(), *executor_) || revises_contact()) {
        for (std::size_t b = 0; b < before.size(); ++b) {
            std::memcpy(state()[b]->host(), before[b].data(), before[b].size());
            changed(*state()[b]);
        }
        hand_over_placed();
        run_step(division, substeps);
    }
    ++frame_;
}

void ManualRun::hand_over_placed() {
    for (BufferStorage* buffer : model->placed_buffers()) changed(*buffer);
    ContactResponse* contact = solver->contact();
    if (contact == nullptr) return;
    for (BufferStorage* buffer : contact->motion().placed_buffers()) changed(*buffer);
}

bool ManualRun::revises_contact() {
    ContactResponse* contact = solver->contact();
    if (contact == nullptr || !contact->revise(*executor_)) return false;
    ++unforeseen;
    return true;
}

void ManualRun::run_step(const Division& division, int substeps) {
    const Step step = solver->make_step(division.partition());
    executor_->run(step, plan_in_order(step, division), substeps);
    for (BufferStorage* buffer : state()) executor_->fetch(*buffer);
}

std::vector<BufferStorage*> ManualRun::state() {
    std::vector<BufferStorage*> buffers = solver->state();
    buffers.push_back(model->positions.get());
    buffers.push_back(model->velocities.get());
    return buffers;
}

std::vector<float> ManualRun::in_scene_order(const Buffer<float4>& buffer) const {
    return model->in_scene_order(buffer.span());
}

std::string ManualRun::hash() const {
    return state_hash(in_scene_order(*model->positions), in_scene_order(*model->velocities));
}

scheduler::Plan plan_in_order(const Step& step, const Division& division) {
    const auto devices = division.devices();
    scheduler::Plan plan;
    for (std::size_t t = 0; t < step.tasks().size(); ++t) {
        const auto start = static_cast<double>(t);
        const int device = devices[index(step.tasks()[t].region)];
        plan.placements.push_back(
            {start, start + 1.0, static_cast<scheduler::ProcessorId>(device)});
    }
    plan.order_by_start(static_cast<scheduler::ProcessorId>(division.strips.size()));
    return plan;
}

}  // namespace weft::test
