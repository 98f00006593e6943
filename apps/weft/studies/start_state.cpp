#include "apps/weft/studies/start_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

#include "runtime/error.h"
#include "simulation/description/run_description.h"
#include "simulation/output/any_checkpoint.h"
#include "simulation/output/geometry_reader.h"

namespace weft {

namespace {

namespace fs = std::filesystem;

bool is_hdf5(const fs::path& path) {
    constexpr std::string_view kMagic = "\x89HDF\r\n\x1a\n";
    std::ifstream in(path, std::ios::binary);
    if (!in) throw UserError("--start " + path.string() + ": no such file, or it cannot be read");
    std::string head(kMagic.size(), '\0');
    in.read(head.data(), static_cast<std::streamsize>(head.size()));
    return in && head == kMagic;
}

[[noreturn]] void refuse(const fs::path& path, const std::string& why) {
    throw UserError(fmt::format("--start {}: {}", path.string(), why));
}

/// In the model's order.
std::vector<float4> read_vectors(const std::vector<std::byte>& bytes) {
    std::vector<float4> values(bytes.size() / sizeof(float4));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float4));
    return values;
}

/// Masses tell one scene, and one order of its vertices, from another.
void check_same_scene(const fs::path& path, const Model& model, const Checkpoint& checkpoint) {
    const std::size_t bytes = model.positions->bytes();
    const auto& buffers = checkpoint.buffers;
    const bool has_size =
        buffers.size() >= 2 && buffers[0].size() == bytes && buffers[1].size() == bytes;
    const auto same_mass = [](const float4& a, const float4& b) { return a.w == b.w; };
    if (has_size &&
        std::ranges::equal(read_vectors(buffers[0]), model.positions->span(), same_mass))
        return;
    refuse(path, "is the checkpoint of another scene: its vertices or their masses differ");
}

StartState from_checkpoint(const fs::path& path, Scene scene) {
    const Checkpoint checkpoint = read_any_checkpoint(path);
    std::string origin;
    for (const auto& [name, value] : settings_of(checkpoint, path)) {
        if (name == "method") scene.solver.method = method_named(value);
        if (name == "origin") origin = value;
    }
    Warnings said_already;
    const Model model(scene, said_already);
    check_same_scene(path, model, checkpoint);
    if (origin != origin_setting(model)) {
        refuse(path,
               "is the checkpoint of another scene, or of a version of weft that counts "
               "positions from another place");
    }
    return {{model.in_scene_order(read_vectors(checkpoint.buffers[0])),
             model.in_scene_order(read_vectors(checkpoint.buffers[1]))},
            checkpoint.frame};
}

/// The step of a file that is at a time.
std::size_t step_at(const GeometryReader& file, const fs::path& path, double dt, int frame) {
    for (std::size_t step = 0; step < file.steps(); ++step) {
        if (std::abs(file.time(step) - frame * dt) < 1e-3 * dt) return step;
    }
    refuse(path, fmt::format("has no state at the start of frame {}", frame));
}

StartState from_geometry(const fs::path& path, const Scene& scene, std::optional<int> wanted) {
    const GeometryReader file(path);
    if (file.steps() == 0) refuse(path, "has no state");
    const double last = file.time(file.steps() - 1) / scene.dt;
    StartState start{{}, wanted.value_or(static_cast<int>(std::lround(last)))};
    const std::size_t step = step_at(file, path, scene.dt, start.frame);
    Warnings said_already;
    start.state.positions = Model(scene, said_already).from_origin(file.positions(step));
    start.state.velocities.resize(start.state.positions.size());
    if (step == 0) return start;
    const std::vector<float> now = file.positions(step), before = file.positions(step - 1);
    const auto per_second = static_cast<float>(1.0 / (file.time(step) - file.time(step - 1)));
    std::ranges::transform(now, before, start.state.velocities.begin(),
                           [&](float to, float from) { return (to - from) * per_second; });
    return start;
}

}  // namespace

StartState read_start(const fs::path& path, const Scene& scene, std::optional<int> frame) {
    StartState start =
        is_hdf5(path) ? from_geometry(path, scene, frame) : from_checkpoint(path, scene);
    if (frame && *frame != start.frame) {
        refuse(path, fmt::format("is at the start of frame {}; leave --frame out", start.frame));
    }
    return start;
}

}  // namespace weft
