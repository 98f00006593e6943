#include "apps/weft/studies/error_problem.h"

#include <fmt/format.h>

#include <cstring>
#include <limits>
#include <utility>

#include "apps/weft/output/progress.h"
#include "apps/weft/process/bytes.h"
#include "apps/weft/process/child_process.h"
#include "runtime/error.h"
#include "simulation/model/substeps.h"

namespace weft {

namespace {

constexpr const char* kContactsBy = "vbd";  ///< it knows all that contacts can do

std::string to_bytes(const State& state) {
    std::string bytes(2 * state.positions.size() * sizeof(float), '\0');
    const std::size_t half = bytes.size() / 2;
    std::memcpy(bytes.data(), state.positions.data(), half);
    std::memcpy(bytes.data() + half, state.velocities.data(), half);
    return bytes;
}

State to_state(const std::string& bytes) {
    const std::size_t half = bytes.size() / 2;
    State state{std::vector<float>(half / sizeof(float)), std::vector<float>(half / sizeof(float))};
    std::memcpy(state.positions.data(), bytes.data(), half);
    std::memcpy(state.velocities.data(), bytes.data() + half, half);
    return state;
}

void set_state(Model& model, const State& state) {
    const std::size_t here = model.positions->count();
    if (state.positions.size() != 3 * here) {
        throw UserError(fmt::format("the state has {} vertices, and the scene {}",
                                    state.positions.size() / 3, here));
    }
    model.from_scene_order(state.positions, model.positions->span());
    model.from_scene_order(state.velocities, model.velocities->span());
}

/// By the scene's own solver, whichever is measured: all of them do the same step.
int substeps_of_scene(const ErrorOptions& options) {
    return with_substeps(read_scene(options.run.scene, options.run.overrides())).substeps;
}

}  // namespace

State state_at(const ErrorOptions& options, const Scene& scene, int frame) {
    if (frame == 0) {
        Warnings warnings;
        const Model model(scene, warnings);
        return {model.in_scene_order(model.positions->span()),
                std::vector<float>(3 * model.positions->count())};
    }
    return to_state(in_child_process("the run up to the frame", [&] {
        Warnings warnings;
        RunOptions run = options.run;
        run.device = options.devices.front();
        Simulation simulation(scene, run.simulation(), warnings);
        Progress progress("frame", frame, options.run.quiet);
        for (int f = 0; f < frame; ++f) {
            simulation.advance();
            progress.show(f + 1);
        }
        return to_bytes({simulation.positions(), simulation.velocities()});
    }));
}

Scene scene_of_step(const ErrorOptions& options, const std::string& solver, int iterations) {
    RunOptions run = options.run;
    run.solver = solver;
    Scene scene = read_scene(run.scene, run.overrides());
    scene.substeps = substeps_of_scene(options);
    if (!options.obstacles) scene.obstacles.clear();
    if (scene.contact) scene.contact->planes = options.planes || options.obstacles;
    scene.dt /= scene.substeps;
    scene.substeps = 1;
    scene.solver.iterations = iterations;
    scene.guard.max_speed = scene.guard.max_strain = std::numeric_limits<double>::infinity();
    return scene;
}

std::vector<FrozenContact> contacts_of_step(const ErrorOptions& options, const State& start,
                                            int substep) {
    const Scene scene = scene_of_step(options, kContactsBy, 1);
    if (!scene.contact) return {};
    return from_bytes<FrozenContact>(in_child_process("the step's contacts", [&] {
        SimulationOptions how = options.run.simulation();
        how.devices = "cpu";
        how.plan = PlanKind::kSingle;
        how.calibrate = false;
        how.on_trouble = OnTrouble::kIgnore;
        Warnings said_already;
        Simulation simulation(scene, how, said_already);
        simulation.start_from(substep, start.positions, start.velocities);
        simulation.advance({.tasks = false});
        return bytes_of(simulation.contacts());
    }));
}

namespace {

/// Contacts are those that vbd finds, in its order of vertices: so the parts of a study have the
/// same numbers, whichever solvers they measure.
Scene scene_of_problem(const ErrorOptions& options) {
    Scene scene = scene_of_step(options, options.solvers.front(), 1);
    return scene.contact ? scene_of_step(options, kContactsBy, 1) : scene;
}

}  // namespace

ErrorProblem::ErrorProblem(const ErrorOptions& options, State state, int substep)
    : model(scene_of_problem(options), warnings), first_substep(substep), start(std::move(state)) {
    set_state(model, start);
    contacts = contacts_of_step(options, start, substep);
    potential = std::make_unique<IncrementalPotential>(model, substep * model.h,
                                                       with_corners(contacts, model.strips.rank));
}

double ErrorProblem::energy(std::span<const Vec3> x) const {
    if (end.empty()) return potential->energy(x);
    double sum = 0.0;
    for (std::size_t v = 0; v < x.size(); ++v) {
        const Vec3 apart = x[v] - end[v];
        sum += 0.5 * potential->inertia()[v] * dot(apart, apart);
    }
    return sum;
}

std::vector<Vec3> ErrorProblem::from_scene_order(const std::vector<float>& positions) const {
    const std::vector<Vec3>& predicted = potential->predicted();
    std::vector<Vec3> x(predicted.size());
    model.from_scene_order(positions, x);
    for (std::size_t v = 0; v < x.size(); ++v) {
        if (!potential->is_free(static_cast<int>(v))) x[v] = predicted[v];
    }
    return x;
}

}  // namespace weft
