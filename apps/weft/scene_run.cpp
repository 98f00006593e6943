#include "apps/weft/scene_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iostream>

#include "apps/weft/progress.h"

namespace weft {

namespace {

/// The kernels' binaries are kept for the next run.
constexpr const char* kFirstTimeNote = " (the first time, OpenCL builds its kernels: some seconds)";

std::filesystem::path folder_for(const RunOptions& options, const Scene& scene) {
    return options.out ? std::filesystem::path(*options.out)
                       : std::filesystem::path("out") / scene.name;
}

bool touches_opencl(const std::string& devices) {
    return devices.find("opencl") != std::string::npos ||
           devices.find("hybrid") != std::string::npos;
}

/// The devices that cannot keep strict arithmetic's promise.
std::vector<std::string> loose_devices(const Simulation& simulation) {
    std::vector<std::string> names;
    for (const auto& device : simulation.devices()) {
        if (!device->info().strict) names.push_back(device->info().name);
    }
    return names;
}

RunDescription describe(const Simulation& simulation, const RunOptions& options) {
    RunDescription run = simulation.describe();
    run.command = command_line();
    run.versions = {{"weft", WEFT_VERSION}};
    run.settings.emplace_back("devices", options.device);
    run.settings.emplace_back("plan", options.plan);
    run.settings.emplace_back("math", options.math);
    if (options.memory != "auto") run.settings.emplace_back("memory", options.memory);
    if (!options.strips.empty()) {
        run.settings.emplace_back("division", fmt::format("{}", fmt::join(options.strips, ",")));
    }
    const std::vector<std::string> loose = loose_devices(simulation);
    if (options.math == "strict" && !loose.empty()) {
        run.settings.emplace_back("not_strict", fmt::format("{}", fmt::join(loose, ", ")));
    }
    return run;
}

std::vector<GeometryBody> geometry_bodies(const Model& model) {
    std::vector<GeometryBody> bodies;
    for (const BodyRange& body : model.bodies) bodies.push_back({body.name, 0});
    for (const int body : model.triangle_body)
        ++bodies[static_cast<std::size_t>(body)].triangle_count;
    return bodies;
}

std::vector<GeometryWriter::Triangle> geometry_triangles(const Model& model) {
    std::vector<GeometryWriter::Triangle> triangles;
    triangles.reserve(model.triangles.size());
    const auto index = [](int vertex) { return static_cast<std::uint32_t>(vertex); };
    for (const auto& t : model.triangles)
        triangles.push_back({index(t[0]), index(t[1]), index(t[2])});
    return triangles;
}

}  // namespace

SceneRun::SceneRun(const RunOptions& options)
    : options_(options),
      scene_(read_scene(options.scene, options.overrides())),
      folder_(folder_for(options, scene_), options.force) {
    set_up();
    folder_.claim();
    const RunDescription description = describe(*simulation_, options_);
    summary_.emplace(description);
    if (!options_.no_trace) trace_.emplace(folder_.trace(), description);
    if (!options_.no_geometry) open_geometry();
}

void SceneRun::set_up() {
    const SimulationOptions settings = options_.simulation();
    if (!options_.quiet) {
        std::cerr << fmt::format("weft: {}: setting up on {}{}\n", scene_.name, options_.device,
                                 touches_opencl(options_.device) ? kFirstTimeNote : "")
                  << std::flush;
    }
    simulation_.emplace(scene_, settings, warnings_);
    if (!options_.quiet) say_what_runs();
}

void SceneRun::say_what_runs() const {
    print_warnings(warnings_);
    if (folder_.replaces_unfinished()) {
        std::cerr << fmt::format("weft: {}: replacing a run that did not finish\n",
                                 folder_.path().string());
    }
    std::vector<std::string> devices;
    for (const auto& device : simulation_->devices()) {
        const DeviceInfo& info = device->info();
        devices.push_back(fmt::format("{} ({}, {} unit{})", info.name, info.kind, info.units,
                                      info.units == 1 ? "" : "s"));
    }
    std::cerr << fmt::format("weft: {}: {} vertices, {} frames on {}\n", scene_.name,
                             simulation_->model().vertex_count(), scene_.frames,
                             fmt::join(devices, " + "));
    if (options_.math != "strict") return;
    for (const std::string& name : loose_devices(*simulation_)) {
        std::cerr << fmt::format(
            "weft: warning: {} does not round divisions and square roots correctly: its results "
            "may differ from those of other devices in the last bits\n",
            name);
    }
}

void SceneRun::open_geometry() {
    const Model& model = simulation_->model();
    const auto triangles = geometry_triangles(model);
    geometry_.emplace(folder_.geometry(), triangles, static_cast<std::size_t>(model.vertex_count()),
                      geometry_bodies(model), static_cast<std::size_t>(scene_.frames) + 1);
    append_geometry();
}

void SceneRun::append_geometry() {
    geometry_->append(simulation_->frame() * scene_.dt, simulation_->positions());
}

void SceneRun::advance_all(const InterruptNotice& notice) {
    Progress progress("frame", scene_.frames, options_.quiet);
    while (frames_done() < scene_.frames && notice.signal() == 0) {
        FrameRecord record = simulation_->advance();
        say_losses();
        summary_->add(record);
        if (trace_) {
            record.state_hash = simulation_->hash();
            trace_->append(std::move(record));
        }
        if (geometry_) append_geometry();
        progress.show(frames_done());
    }
}

/// Even where talk is not wanted: the rest of the run is slower than was asked for.
void SceneRun::say_losses() {
    const auto& losses = simulation_->losses();
    for (; losses_said_ < losses.size(); ++losses_said_) {
        std::cerr << fmt::format("weft: warning: {}\n", text_of(losses[losses_said_]));
    }
}

std::string SceneRun::text_of(const LostDevice& lost) const {
    const auto& device = simulation_->devices()[static_cast<std::size_t>(lost.device)];
    return fmt::format("device {} ({}) was lost in frame {}, the others go on without it: {}",
                       lost.device, device->info().name, lost.frame, lost.why);
}

RunSummary SceneRun::finish() {
    simulation_->save_costs();
    RunSummary summary = summary_->summary();
    for (const LostDevice& lost : simulation_->losses()) summary.losses.push_back(text_of(lost));
    summary.finished = frames_done() == scene_.frames;
    summary.state_hash = simulation_->hash();
    if (trace_) {
        if (summary.finished) trace_->finish(summary.state_hash);
        trace_.reset();
        summary.files.emplace_back("trace", folder_.trace().string());
    }
    if (geometry_) {
        geometry_->finish();
        summary.files.emplace_back("geometry", folder_.geometry().string());
        summary.files.emplace_back("xdmf", GeometryWriter::xdmf_path(folder_.geometry()).string());
    }
    summary.files.emplace_back("summary", folder_.summary().string());
    write_summary(folder_.summary(), summary);
    return summary;
}

}  // namespace weft
