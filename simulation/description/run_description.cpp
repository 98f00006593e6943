#include "simulation/description/run_description.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "simulation/bodies/mesh_files.h"
#include "simulation/solver/async_iterates.h"
#include "simulation/state/diagnostics.h"

namespace weft {

namespace {

TextPairs settings_of(const Model& model, const Solver& solver) {
    const Scene& scene = model.scene;
    TextPairs settings{{"method", std::string(name_of(scene.solver.method))},
                       {"frames", std::to_string(scene.frames)},
                       {"dt", fmt::format("{}", scene.dt)},
                       {"substeps", std::to_string(scene.substeps)},
                       {"iterations", std::to_string(scene.solver.iterations)},
                       {"vertices", std::to_string(model.vertex_count())},
                       {"strips", std::to_string(model.strips.count())}};
    if (scene.solver.tolerance > 0.0) {
        settings.emplace_back("tolerance", fmt::format("{}", scene.solver.tolerance));
    }
    if (const std::string origin = origin_setting(model); !origin.empty()) {
        settings.emplace_back("origin", origin);
    }
    if (solver.iterate_count() > 1) {
        settings.emplace_back("iterates", std::to_string(solver.iterate_count()));
    }
    if (const auto* async = dynamic_cast<const AsyncIterates*>(&solver)) {
        settings.emplace_back("async", to_text(async->settings()));
    }
    if (!scene.overrides.empty()) {
        settings.emplace_back("set", fmt::format("{}", fmt::join(scene.overrides, "\n")));
    }
    return settings;
}

DeviceDescription describe(const DeviceInfo& info) {
    return {info.name,
            info.kind,
            info.driver,
            static_cast<std::uint32_t>(info.units),
            std::string(name_of(info.memory)),
            info.strict,
            static_cast<std::uint32_t>(info.team)};
}

}  // namespace

std::string origin_setting(const Model& model) {
    const Vec3 o = model.origin;
    return o == Vec3{} ? "" : fmt::format("{} {} {}", o.x, o.y, o.z);
}

RunDescription describe_run(const Model& model, const Solver& solver,
                            const std::vector<std::unique_ptr<Device>>& devices) {
    const Scene& scene = model.scene;
    RunDescription run;
    run.scene_name = scene.name;
    run.scene_text = scene.text;
    if (!scene.path.empty()) run.scene_path = std::filesystem::absolute(scene.path).string();
    for (const BodyMesh& mesh : mesh_files(scene)) {
        run.meshes.emplace_back(mesh.body, mesh_hash(mesh));
    }
    run.settings = settings_of(model, solver);
    for (const auto& device : devices) {
        run.devices.push_back(describe(device->info()));
        if (device->info().memory != MemoryModel::kHost && devices.size() > 1)
            run.has_transfers = true;
    }
    run.has_contacts = scene.contact && !model.triangles.empty();
    run.kinds = solver.kinds();
    run.energies = energy_names(model);
    return run;
}

}  // namespace weft
