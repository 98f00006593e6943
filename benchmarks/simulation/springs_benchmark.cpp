#include <benchmark/benchmark.h>

#include "benchmarks/simulation/plain_springs.h"
#include "runtime/tbb/cpu_device.h"
#include "simulation/families/springs/springs.h"
#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"
#include "simulation/topology/adjacency.h"

// A hanging sheet of springs alone, frames of 10 substeps x 8 iterations on one core: the plain
// loop against the packed and the scalar kernels. The counter is the time per projection.
namespace {

using namespace weft;

constexpr int kSubsteps = 10;
constexpr int kIterations = 8;

Scene sheet(int resolution) {
    const std::string n = std::to_string(resolution);
    return parse_scene(R"(
[scene]
name = "sheet"
frames = 1000000
dt = 0.016666667
substeps = 10
[solver]
iterations = 8
[[cloth]]
name = "sheet"
grid = { size = [1.0, 1.0], resolution = [)" +
                           n + ", " + n + R"(] }
density = 0.2
stretch = { stiffness = 1.0e4 }
pins = { corners = ["x-z-", "x+z-"] }
)",
                       "sheet.toml");
}

void count_projections(benchmark::State& state, int springs) {
    state.counters["per_projection"] = benchmark::Counter(
        static_cast<double>(springs) * kSubsteps * kIterations,
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void BM_PlainLoop(benchmark::State& state) {
    Warnings warnings;
    const Model model(sheet(static_cast<int>(state.range(0))), warnings);
    // Vertices and springs in the order of the mesh, as a plain program has them.
    std::vector<PlainSprings::Particle> particles(static_cast<std::size_t>(model.vertex_count()));
    for (std::size_t v = 0; v < particles.size(); ++v) {
        const float4& x = (*model.positions)[v];
        particles[static_cast<std::size_t>(model.strips.order[v])] = {x.x, x.y, x.z, x.w};
    }
    std::vector<int> corners;
    for (const auto& t : model.triangles) corners.insert(corners.end(), t.begin(), t.end());
    const Adjacency adjacency = find_adjacency(model.vertex_count(), corners);
    PlainSprings springs(std::move(particles), adjacency.edges, 1.0e-4f);
    for (auto _ : state) {
        for (int sweep = 0; sweep < kSubsteps * kIterations; ++sweep) springs.sweep(360000.0f);
    }
    count_projections(state, static_cast<int>(springs.spring_count()));
}

void run_weft(benchmark::State& state, int lanes) {
    Warnings warnings;
    SimulationOptions options;
    options.devices = "cpu/1";
    options.device_options.cpu_lanes = lanes;
    Simulation simulation(sheet(static_cast<int>(state.range(0))), options, warnings);
    for (auto _ : state) {
        // The substeps alone; the checks and energies of a frame are not part of the comparison.
        state.SetIterationTime(simulation.advance().measured_makespan);
    }
    count_projections(state, simulation.model().find<Springs>()->elements().count());
    state.SetLabel("state " + simulation.hash().substr(0, 8) + " after " +
                   std::to_string(simulation.frame()) + " frames");
}

void BM_Packs(benchmark::State& state) { run_weft(state, 0); }
void BM_PacksOf8(benchmark::State& state) { run_weft(state, 8); }
void BM_Scalar(benchmark::State& state) { run_weft(state, 1); }

// Repetitions in turn, so that a change of the machine's speed meets all alike.
void settings(benchmark::internal::Benchmark* benchmark) {
    benchmark->Arg(200)->Iterations(3)->Repetitions(5)->Unit(benchmark::kMillisecond);
}

BENCHMARK(BM_PlainLoop)->Apply(settings);
BENCHMARK(BM_Packs)->Apply(settings)->UseManualTime();
BENCHMARK(BM_PacksOf8)->Apply(settings)->UseManualTime();
BENCHMARK(BM_Scalar)->Apply(settings)->UseManualTime();

}  // namespace
