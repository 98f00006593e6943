#include "apps/weft/studies/whole_run.h"

#include <cmath>

#include "apps/weft/output/progress.h"

namespace weft {

RunOptions with_steps(RunOptions run, int substeps, int iterations) {
    run.substeps = std::to_string(substeps);
    run.iterations = std::to_string(iterations);
    return run;
}

TimedRun run_scene(const RunOptions& run, Progress* progress) {
    Warnings warnings;
    const Scene scene = read_scene(run.scene, run.overrides());
    SimulationOptions settings = run.simulation();
    settings.on_trouble = OnTrouble::kIgnore;  // what it comes to is what is measured
    Simulation simulation(scene, settings, warnings);
    TimedRun timed;
    for (int frame = 0; frame < scene.frames; ++frame) {
        timed.time += simulation.advance().measured_makespan;
        const std::vector<float> positions = simulation.positions();
        timed.trajectory.insert(timed.trajectory.end(), positions.begin(), positions.end());
        if (progress != nullptr) progress->show(frame + 1);
    }
    return timed;
}

double distance(const Trajectory& a, const Trajectory& b, std::size_t numbers) {
    double sum = 0.0;
    for (std::size_t k = a.size() - numbers; k < a.size(); ++k) {
        const double off = static_cast<double>(a[k]) - static_cast<double>(b[k]);
        sum += off * off;
    }
    return std::sqrt(3.0 * sum / static_cast<double>(numbers));
}

double distance(const Trajectory& a, const Trajectory& b) { return distance(a, b, a.size()); }

}  // namespace weft
