#include "simulation/state/simulation_state.h"

#include <algorithm>
#include <span>

#include "runtime/error.h"
#include "simulation/output/state_hash.h"

namespace weft {

namespace {

std::span<const std::byte> bytes_of(const BufferStorage& buffer) {
    return {static_cast<const std::byte*>(buffer.host()), buffer.bytes()};
}

}  // namespace

void SimulationState::take(const Model& model, Solver& method) {
    const auto copy = [](std::vector<float4>& to, const Buffer<float4>& from) {
        to.assign(from.data(), from.data() + from.count());
    };
    copy(positions, *model.positions);
    copy(velocities, *model.velocities);
    const auto buffers = method.state();
    solver.resize(buffers.size());
    for (std::size_t b = 0; b < buffers.size(); ++b) {
        const auto bytes = bytes_of(*buffers[b]);
        solver[b].assign(bytes.begin(), bytes.end());
    }
}

void SimulationState::put(Model& model, Solver& method) const {
    std::ranges::copy(positions, model.positions->data());
    std::ranges::copy(velocities, model.velocities->data());
    const auto buffers = method.state();
    for (std::size_t b = 0; b < buffers.size(); ++b) {
        std::ranges::copy(solver[b], static_cast<std::byte*>(buffers[b]->host()));
    }
}

std::vector<float> SimulationState::ordered_positions(const Model& model) const {
    return model.in_scene_order(positions);
}

std::vector<float> SimulationState::ordered_velocities(const Model& model) const {
    return model.in_scene_order(velocities);
}

std::string SimulationState::hash(const Model& model) const {
    const Vec3 o = model.origin;
    return state_hash(model.strips.rank, positions, velocities, {o.x, o.y, o.z});
}

Checkpoint SimulationState::checkpoint(int frame) const {
    const auto bytes = [](const std::vector<float4>& values) {
        const auto view = std::as_bytes(std::span(values));
        return std::vector<std::byte>(view.begin(), view.end());
    };
    Checkpoint checkpoint;
    checkpoint.frame = frame;
    checkpoint.buffers = {bytes(positions), bytes(velocities)};
    checkpoint.buffers.insert(checkpoint.buffers.end(), solver.begin(), solver.end());
    return checkpoint;
}

void SimulationState::take(const Checkpoint& checkpoint) {
    std::vector<std::span<std::byte>> buffers{std::as_writable_bytes(std::span(positions)),
                                              std::as_writable_bytes(std::span(velocities))};
    for (auto& buffer : solver) buffers.emplace_back(buffer);
    const auto sizes_match = [](const auto& a, const auto& b) { return a.size() == b.size(); };
    if (!std::ranges::equal(buffers, checkpoint.buffers, sizes_match)) {
        throw UserError("the checkpoint is of another scene: its state has another size");
    }
    for (std::size_t b = 0; b < buffers.size(); ++b) {
        std::ranges::copy(checkpoint.buffers[b], buffers[b].begin());
    }
}

}  // namespace weft
