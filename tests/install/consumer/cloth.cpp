// Three frames of a small sheet that hangs by two corners, by weft::simulation.
#include <algorithm>
#include <cstdio>

#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"

int main() {
    const weft::Scene scene = weft::parse_scene(R"(
        [scene]
        frames = 3
        dt = 0.02
        substeps = 4
        [solver]
        method = "xpbd"
        iterations = 4
        [[cloth]]
        grid = { size = [1.0, 1.0], resolution = [8, 8] }
        density = 0.2
        stretch = { stiffness = 1.0e4 }
        pins = { corners = ["x-z-", "x+z-"] }
    )",
                                                "hanging.toml");
    weft::SimulationOptions options;
    options.devices = "cpu/1";
    weft::Warnings warnings;
    weft::Simulation simulation(scene, options, warnings);
    while (simulation.frame() < 3) simulation.advance();

    float lowest = 0.0f;
    const std::vector<float> positions = simulation.positions();
    for (std::size_t i = 1; i < positions.size(); i += 3) lowest = std::min(lowest, positions[i]);
    std::printf("state %s, lowest vertex at %g m\n", simulation.hash().c_str(),
                static_cast<double>(lowest));
    return lowest < 0.0f ? 0 : 1;
}
