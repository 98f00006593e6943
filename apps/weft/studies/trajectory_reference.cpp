#include "apps/weft/studies/trajectory_reference.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/weft/output/progress.h"
#include "apps/weft/process/bytes.h"
#include "apps/weft/process/child_process.h"
#include "runtime/error.h"
#include "simulation/reference/fine_run.h"

namespace weft {

namespace {

// Of runs with [contact]: who solves steps best, and enough for any as short as these.
constexpr const char* kSolver = "newton";
constexpr int kIterations = 12;

Progress progress_of(int substeps, int frames, bool quiet) {
    return {fmt::format("reference with {} substeps, frame", substeps), frames, quiet};
}

[[noreturn]] void refuse(int substeps, int least, const char* why) {
    throw UserError(
        fmt::format("--reference-substeps {}: expected {} or more: {}", substeps, least, why));
}

int twice_the_finest(const ErrorOptions& options) {
    return 2 * std::ranges::max(options.sweep_substeps);
}

constexpr const char* kTwice = "twice the most of --sweep-substeps";

Trajectory fine_run(Model& model, int substeps, bool quiet) {
    FineRun run(model, substeps);
    Progress progress = progress_of(substeps, model.scene.frames, quiet);
    Trajectory trajectory;
    for (int frame = 0; frame < model.scene.frames; ++frame) {
        run.advance();
        const std::vector<float> positions = run.positions();
        trajectory.insert(trajectory.end(), positions.begin(), positions.end());
        progress.show(frame + 1);
    }
    return trajectory;
}

/// Far more than what is swept; and since it is to be checked by half as many, that is stable too.
int explicit_substeps(const ErrorOptions& options, const Model& model) {
    const int wanted = twice_the_finest(options);
    const int stable = FineRun::stable_substeps(model);
    const int least = std::max(wanted, stable);
    const int substeps = options.reference_substeps.value_or(std::max(2 * stable, 4 * wanted));
    if (substeps >= least) return substeps;
    refuse(substeps, least,
           least > stable
               ? kTwice
               : "the reference's steps are explicit, and with fewer they are not stable");
}

TrajectoryReference explicit_reference(const ErrorOptions& options, const Scene& scene) {
    Warnings warnings;
    Model model(scene, warnings);
    const int substeps = explicit_substeps(options, model);
    const bool quiet = options.run.quiet;
    TrajectoryReference reference{"explicit steps in double precision", model.vertex_count(),
                                  substeps, fine_run(model, substeps, quiet), 0.0};
    reference.doubt = distance(reference.trajectory, fine_run(model, substeps / 2, quiet));
    return reference;
}

/// No more than twice as fine as the finest run: in single precision, what gravity does in very
/// short steps is lost to rounding.
int solved_substeps(const ErrorOptions& options) {
    const int least = twice_the_finest(options);
    const int substeps = options.reference_substeps.value_or(least);
    if (substeps < least) refuse(substeps, least, kTwice);
    return substeps;
}

TrajectoryReference solved_reference(const ErrorOptions& options, const Scene& scene) {
    const auto run = [&](int substeps) {
        RunOptions fine = with_steps(options.run, substeps, kIterations);
        fine.solver = kSolver;
        fine.device = "cpu";
        return from_bytes<float>(in_child_process("the reference", [&] {
            Progress progress = progress_of(substeps, scene.frames, options.run.quiet);
            return bytes_of(run_scene(fine, &progress).trajectory);
        }));
    };
    const int substeps = solved_substeps(options);
    TrajectoryReference reference{fmt::format("{} with {} iterations", kSolver, kIterations), 0,
                                  substeps, run(substeps), 0.0};
    const std::size_t numbers = 3 * static_cast<std::size_t>(scene.frames);
    reference.vertices = static_cast<int>(reference.trajectory.size() / numbers);
    reference.doubt = distance(reference.trajectory, run(substeps / 2));
    return reference;
}

bool is_for_solvers(const Scene& scene) {
    if (scene.contact) return true;
    const Model model(scene);
    return model.obstacles && model.obstacles->narrow() != nullptr;
}

}  // namespace

TrajectoryReference run_reference(const ErrorOptions& options) {
    const Scene scene = read_scene(options.run.scene, options.run.overrides());
    return is_for_solvers(scene) ? solved_reference(options, scene)
                                 : explicit_reference(options, scene);
}

}  // namespace weft
