#include "apps/weft/run/scene_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "apps/weft/output/progress.h"
#include "apps/weft/output/warnings.h"
#include "apps/weft/run/run_origin.h"
#include "apps/weft/run/run_record.h"
#include "apps/weft/run/settled_choice.h"
#include "runtime/clock.h"
#include "runtime/device_list.h"
#include "runtime/error.h"
#include "runtime/io/cache_folder.h"
#include "simulation/scene/auto_method.h"

namespace weft {

namespace {

/// The kernels' binaries are kept for the next run.
constexpr const char* kFirstTimeNote =
    " (the first time, OpenCL builds its kernels: seconds, with contact up to a minute)";

EarlierOutput earlier_output(const RunOptions& options) {
    if (options.force) return EarlierOutput::kReplace;
    return options.resume ? EarlierOutput::kResume : EarlierOutput::kKeep;
}

}  // namespace

SceneRun::SceneRun(const RunOptions& options, bool keeps_checkpoint)
    : options_(options),
      keeps_checkpoint_(keeps_checkpoint),
      scene_(read_scene(options.scene, options.overrides())),
      origin_(request_parts(options, scene_)),
      folder_(options.folder_for(scene_.name), earlier_output(options)) {
    if (!options.no_geometry) check_geometry_states(scene_, options.scene);
    const std::optional<FinishedRun> finished = find_finished();
    settle_solver();
    set_up();
    RunDescription description = describe();
    origin_ = run_origin(std::move(origin_), options_, description.meshes, *simulation_);
    if (finished) {
        if (finished->made_from != origin_) folder_.refuse_finished();
        done_ = finished->text;
        return;
    }
    if (options_.resume) find_earlier(description);
    if (!earlier_) warn_of_other_scene();
    description.warnings = all_warnings();
    claim_folder();
    summary_.emplace(description);
    if (!options_.no_trace) trace_.emplace(folder_.trace(), description);
    if (!options_.no_geometry) open_geometry();
    if (earlier_) take_over();
    last_checkpoint_ = now();
}

/// A run that is whole, of as many frames and with the outputs that are asked for; whether it is of
/// the same scene is not known yet.
std::optional<FinishedRun> SceneRun::find_finished() const {
    if (!options_.resume || !folder_.has_finished()) return std::nullopt;
    auto run = read_finished(folder_.summary());
    const bool is_whole = run && run->frames == scene_.frames &&
                          (options_.no_trace || std::filesystem::exists(folder_.trace())) &&
                          (options_.no_geometry || std::filesystem::exists(folder_.geometry()));
    if (!is_whole) folder_.refuse_finished();
    return run;
}

void SceneRun::settle_solver() {
    if (!auto_method(scene_)) return;
    const SolverChoice choice = settled_choice(scene_, options_, folder_.checkpoint());
    scene_ = with_choice(std::move(scene_), choice);
    solver_choice_ = choice.why;
}

RunDescription SceneRun::describe() const {
    RunDescription description = describe_run(*simulation_, options_);
    if (!solver_choice_.empty()) description.settings.emplace_back("solver_choice", solver_choice_);
    return description;
}

/// Where nothing was left to go on from, the run begins at the beginning.
void SceneRun::find_earlier(const RunDescription& description) {
    const auto checkpoint = read_checkpoint(folder_.checkpoint(), origin_);
    if (!checkpoint) return;
    if (checkpoint->frame > scene_.frames) {
        throw UserError(fmt::format("--resume: {} frames are done already, and {} are asked for",
                                    checkpoint->frame, scene_.frames));
    }
    const Outputs outputs = {.trace = !options_.no_trace,
                             .geometry = !options_.no_geometry,
                             .state_interval = scene_.output.every * scene_.dt,
                             .states = geometry_states(scene_, checkpoint->frame)};
    earlier_.emplace(folder_, *checkpoint, outputs, description);
    simulation_->resume(*checkpoint);
    warn_of_missing_outputs();
}

/// They may be gone, or the run has begun without them.
void SceneRun::warn_of_missing_outputs() {
    if (earlier_->frames() == 0) return;
    const auto warn = [&](const std::filesystem::path& file) {
        warnings_.push_back(
            fmt::format("{}: nothing of it is there from before frame {}, so it begins there",
                        file.string(), earlier_->frames()));
        print_warnings({warnings_.back()});
    };
    if (!options_.no_trace && !earlier_->has_trace()) warn(folder_.trace());
    if (!options_.no_geometry && !earlier_->has_geometry()) warn(folder_.geometry());
}

/// Replacing a run of the same scene is what whoever works on a scene does all the time.
void SceneRun::warn_of_other_scene() {
    const std::string other = folder_.unfinished_scene();
    if (other.empty() || other == scene_.name) return;
    warnings_.push_back(
        fmt::format("{}: this replaces a run of another scene, '{}', that did not finish; another "
                    "--out keeps both",
                    folder_.path().string(), other));
    print_warnings({warnings_.back()});
}

void SceneRun::claim_folder() {
    if (!earlier_) {
        folder_.claim();
        if (folder_.replaces_unfinished() && !options_.resume && !options_.quiet) {
            std::cerr << fmt::format("weft: {}: replacing a run that did not finish\n",
                                     folder_.path().string());
        }
        return;
    }
    std::vector<std::filesystem::path> outputs;
    if (!options_.no_trace) outputs.push_back(folder_.trace());
    if (!options_.no_geometry) outputs.push_back(folder_.geometry());
    folder_.claim_to_go_on(outputs);
}

void SceneRun::take_over() {
    earlier_->hand_over(*summary_);
    clock_offset_ = summary_->end();
    if (trace_) earlier_->hand_over(*trace_);
    if (geometry_) earlier_->hand_over(geometry_->writer());
    if (!options_.quiet) {
        std::cerr << fmt::format("weft: {}: going on after {} of {} frames\n", scene_.name,
                                 earlier_->frames(), scene_.frames);
    }
    earlier_.reset();
    folder_.forget_before();
}

void SceneRun::set_up() {
    check_device_list(options_.device);
    options_.check_async();
    const SimulationOptions settings = options_.simulation();
    if (!options_.quiet) {
        std::cerr << fmt::format("weft: {}: setting up on {}{}\n", scene_.name, options_.device,
                                 touches_opencl(options_.device) ? kFirstTimeNote : "")
                  << std::flush;
    }
    const std::string trouble = cache_folder_trouble();
    if (!trouble.empty()) warnings_.push_back(trouble);
    simulation_.emplace(scene_, settings, warnings_);
    print_warnings(all_warnings());
    if (!options_.quiet) say_what_runs();
}

void SceneRun::say_what_runs() const {
    std::vector<std::string> devices;
    for (const auto& device : simulation_->devices()) {
        const DeviceInfo& info = device->info();
        devices.push_back(fmt::format("{} ({}, {} unit{})", info.name, info.kind, info.units,
                                      info.units == 1 ? "" : "s"));
    }
    const Model& model = simulation_->model();
    if (!solver_choice_.empty()) {
        std::cerr << fmt::format("weft: {}: solver {}: {}\n", scene_.name,
                                 name_of(scene_.solver.method), solver_choice_);
    }
    std::cerr << fmt::format(
        "weft: {}: {} vertices, {} substeps x {} iterations, {} frames on {}\n", scene_.name,
        model.vertex_count(), model.scene.substeps, scene_.solver.iterations, scene_.frames,
        fmt::join(devices, " + "));
    if (options_.async && !simulation_->async_choice().empty()) {
        std::cerr << fmt::format("weft: {}\n", simulation_->async_choice());
    }
}

Warnings SceneRun::all_warnings() const {
    Warnings warnings = warnings_;
    if (options_.math != "strict") return warnings;
    for (const std::string& name : loose_devices(*simulation_)) {
        warnings.push_back(fmt::format(
            "{} does not round divisions and square roots correctly: its results may differ from "
            "those of other devices in the last bits",
            name));
    }
    return warnings;
}

void SceneRun::open_geometry() {
    geometry_.emplace(folder_.geometry(), scene_, simulation_->model());
    if (!earlier_ || !earlier_->has_geometry()) geometry_->append(*simulation_);
}

void SceneRun::advance_all(const InterruptNotice& notice) {
    Progress progress("frame", scene_.frames, options_.quiet);
    last_end_ = simulation_->clock();
    while (frames_done() < scene_.frames && notice.signal() == 0) {
        keep_checkpoint();
        FrameRecord record = advance();
        say_losses(record);
        say_troubles(record.warnings);
        // First of all, so that a killed run's trace is no more than one frame behind its geometry.
        if (trace_) trace_->settle();
        if (geometry_) geometry_->append(*simulation_);
        if (std::isfinite(record.relative_error)) {
            convergence_ = fmt::format("error of a step {:.1g}", record.relative_error);
        }
        progress.show(frames_done(), convergence_);
        close(record);
        summary_->add(record);
        if (trace_) append_trace(std::move(record));
    }
}

/// What was seen and done before a frame ended the run is said, too.
FrameRecord SceneRun::advance() {
    try {
        return simulation_->advance({.tasks = trace_.has_value()});
    } catch (const RunError&) {
        Warnings of_no_record;
        say_troubles(of_no_record);
        throw;
    }
}

/// The hash is found out while the next frame runs.
void SceneRun::append_trace(FrameRecord record) {
    trace_->append(std::move(record),
                   [model = simulation_->shared_model(), state = simulation_->snapshot()](
                       FrameRecord& frame) { frame.state_hash = state->hash(*model); });
}

/// All time since the record before was closed belongs to this one.
void SceneRun::close(FrameRecord& record) {
    const double end = simulation_->clock();
    record.output_time = record.start - last_end_ + end - record.end;
    record.start = last_end_;
    record.end = last_end_ = end;
    shift_times(record, clock_offset_);
}

/// Appending waits for the frame before to be on disk. So a checkpoint is written one frame after
/// it was taken: then trace and geometry hold all of its frames.
void SceneRun::keep_checkpoint() {
    if (pending_) {
        write_checkpoint(folder_.checkpoint(), origin_, *pending_);
        pending_.reset();
    }
    if (now() - last_checkpoint_ < options_.checkpoint) return;
    pending_ = checkpoint();
    last_checkpoint_ = now();
}

Checkpoint SceneRun::checkpoint() const {
    Checkpoint checkpoint = simulation_->checkpoint();
    checkpoint.report = summary_->save();
    return checkpoint;
}

/// Even where talk is not wanted: the rest of the run is slower than was asked for.
void SceneRun::say_losses(FrameRecord& record) {
    const auto& losses = simulation_->losses();
    for (; losses_said_ < losses.size(); ++losses_said_) {
        const std::string text = text_of(losses[losses_said_], *simulation_);
        std::cerr << fmt::format("weft: warning: {}\n", text);
        record.warnings.push_back(text);
    }
}

/// Warnings of the results, on stderr, in the summary, and in the trace's record.
void SceneRun::say_troubles(Warnings& record) {
    const auto& troubles = simulation_->troubles();
    for (; troubles_said_ < troubles.size(); ++troubles_said_) {
        const Trouble& trouble = troubles[troubles_said_];
        const std::string text = text_of(trouble);
        std::cerr << fmt::format("weft: warning: {}\n", text);
        summary_->warn(text);
        record.push_back(trouble.what);
    }
}

RunSummary SceneRun::finish() {
    simulation_->save_costs();
    RunSummary summary = summary_->summary();
    for (const LostDevice& lost : simulation_->losses()) {
        summary.losses.push_back(text_of(lost, *simulation_));
    }
    const Warnings more = all_warnings();
    summary.warnings.insert(summary.warnings.begin(), more.begin(), more.end());
    summary.finished = frames_done() == scene_.frames;
    summary.state_hash = simulation_->hash();
    summary.made_from = origin_;
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
    const bool is_kept = !summary.finished || keeps_checkpoint_;
    if (is_kept) write_checkpoint(folder_.checkpoint(), origin_, checkpoint());
    if (summary.finished && is_kept)
        summary.files.emplace_back("checkpoint", folder_.checkpoint().string());
    write_summary(folder_.summary(), summary);
    if (!is_kept) std::filesystem::remove(folder_.checkpoint());
    return summary;
}

}  // namespace weft
