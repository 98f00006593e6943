#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>

#include "apps/weft/command_line/common_options.h"
#include "apps/weft/commands/commands.h"
#include "apps/weft/output/warnings.h"
#include "runtime/io/json_text.h"
#include "simulation/description/inspect.h"
#include "simulation/scene/auto_method.h"

namespace weft {

namespace {

using nlohmann::ordered_json;

std::size_t all_bytes(const Inspection& inspection) {
    return std::accumulate(
        inspection.buffers.begin(), inspection.buffers.end(), std::size_t{0},
        [](std::size_t sum, const Inspection::Buffer& buffer) { return sum + buffer.bytes; });
}

ordered_json tasks_json(const std::vector<Inspection::Task>& tasks) {
    ordered_json list = ordered_json::array();
    for (const Inspection::Task& task : tasks) {
        ordered_json launches = ordered_json::array();
        for (const Inspection::Launch& launch : task.launches) {
            launches.push_back(
                {{"kernel", launch.kernel}, {"items", launch.items}, {"colours", launch.colours}});
        }
        list.push_back({{"kind", task.kind},
                        {"per_substep", task.per_substep},
                        {"launches", std::move(launches)}});
    }
    return list;
}

ordered_json to_json(const Inspection& inspection, const Scene& scene) {
    ordered_json json{{"scene", scene.name},
                      {"frames", scene.frames},
                      {"substeps", scene.substeps},
                      {"iterations", scene.solver.iterations},
                      {"vertices", inspection.vertices},
                      {"triangles", inspection.triangles},
                      {"strips", inspection.strips}};
    if (const Vec3 o = inspection.origin; !(o == Vec3{})) json["origin"] = {o.x, o.y, o.z};
    json["tasks"] = tasks_json(inspection.tasks);
    for (const char* key : {"kernels", "buffers", "datasets", "left_out"}) {
        json[key] = ordered_json::array();
    }
    for (const auto& kernel : inspection.kernels) {
        json["kernels"].push_back({{"name", kernel.name}, {"file", kernel.file}});
    }
    for (const auto& buffer : inspection.buffers) {
        json["buffers"].push_back({{"name", buffer.name}, {"bytes", buffer.bytes}});
    }
    for (const auto& dataset : inspection.datasets) {
        json["datasets"].push_back({{"name", dataset.name}, {"columns", dataset.columns}});
    }
    for (const auto& item : inspection.left_out) {
        json["left_out"].push_back(
            {{"what", item.what}, {"why", item.why}, {"kernels", item.kernels}});
    }
    return json;
}

std::string size_text(std::size_t bytes) {
    const double value = static_cast<double>(bytes);
    if (bytes < 10'000) return fmt::format("{} B", bytes);
    if (bytes < 10'000'000) return fmt::format("{:.1f} kB", value / 1e3);
    return fmt::format("{:.1f} MB", value / 1e6);
}

std::string tasks_text(const std::vector<Inspection::Task>& tasks) {
    std::string text = "tasks                    in a substep on one device\n";
    for (const Inspection::Task& task : tasks) {
        text += fmt::format("  {:<22} {}x\n", task.kind, task.per_substep);
        for (const Inspection::Launch& launch : task.launches) {
            text += fmt::format("    {:<28} {:>9} items", launch.kernel, launch.items);
            if (launch.colours > 1) text += fmt::format(" in {} colours", launch.colours);
            text += '\n';
        }
    }
    return text;
}

std::string to_text(const Inspection& inspection, const Scene& scene) {
    std::string text = fmt::format(
        "{}: {} vertices, {} triangles, {} strip{}; {} frames of {} substeps of {} iterations\n\n",
        scene.name, inspection.vertices, inspection.triangles, inspection.strips,
        inspection.strips == 1 ? "" : "s", scene.frames, scene.substeps, scene.solver.iterations);
    if (const Vec3 o = inspection.origin; !(o == Vec3{})) {
        text +=
            fmt::format("positions count from ({}, {}, {}), near the bodies\n\n", o.x, o.y, o.z);
    }
    text += tasks_text(inspection.tasks);
    text += "\nkernels\n";
    for (const auto& kernel : inspection.kernels) {
        text += fmt::format("  {:<28} {}\n", kernel.name, kernel.file);
    }
    text += fmt::format("\nbuffers                  {}\n", size_text(all_bytes(inspection)));
    for (const auto& buffer : inspection.buffers) {
        text += fmt::format("  {:<22} {}\n", buffer.name, size_text(buffer.bytes));
    }
    text += "\ndatasets of trace.h5\n";
    for (const auto& dataset : inspection.datasets) {
        text += fmt::format("  {:<12} {}\n", dataset.name, fmt::join(dataset.columns, " "));
    }
    text += "\nleft out\n";
    for (const auto& item : inspection.left_out) {
        text += fmt::format("  {}: {}\n", item.what, item.why);
        if (!item.kernels.empty())
            text += fmt::format("      no {}\n", fmt::join(item.kernels, ", "));
    }
    return text;
}

void inspect_scene(const RunOptions& options) {
    const Scene scene = read_scene(options.scene, options.overrides());
    Warnings warnings;
    Model model(scene, warnings);
    const auto solver = make_solver(model);
    if (auto_method(scene)) {
        warnings.push_back(
            fmt::format("solver.method = \"auto\" is measured when the scene runs; "
                        "this is what {} would do",
                        name_of(scene.solver.method)));
    }
    if (!options.quiet) print_warnings(warnings);
    const Inspection inspection = inspect(model, *solver);
    if (options.json)
        std::cout << json_text(to_json(inspection, model.scene)) << '\n';
    else
        std::cout << to_text(inspection, model.scene);
}

}  // namespace

void add_inspect_command(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("inspect", "Say what a scene needs, and what was left out and why");
    const auto options = std::make_shared<RunOptions>();
    add_scene_options(*command, *options);
    add_talk_options(*command, *options);
    command->footer(
        "Uses no device.\n\n"
        "Examples:\n"
        "  weft inspect scenes/tablecloth.toml\n"
        "  weft inspect scenes/tablecloth.toml --set obstacle=[] --set cloth.bend.stiffness=0 "
        "--json");
    command->callback([options] { inspect_scene(*options); });
}

}  // namespace weft
