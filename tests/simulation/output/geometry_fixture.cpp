// Writes a geometry file for tests: geometry_fixture PATH STEPS GRID [PAUSE_MS]
// Two bodies, each a waving square of GRID x GRID vertices. With a pause it prints a line per step.

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include "simulation/output/geometry_writer.h"

namespace {

using Triangle = weft::GeometryWriter::Triangle;

std::vector<Triangle> squares(std::uint32_t grid) {
    std::vector<Triangle> triangles;
    for (const std::uint32_t base : {0U, grid * grid}) {
        for (std::uint32_t row = 0; row + 1 < grid; ++row) {
            for (std::uint32_t column = 0; column + 1 < grid; ++column) {
                const std::uint32_t corner = base + row * grid + column;
                triangles.push_back({corner, corner + grid, corner + 1});
                triangles.push_back({corner + 1, corner + grid, corner + grid + 1});
            }
        }
    }
    return triangles;
}

/// x and z span the unit square; y = body + 0.1 sin(2 pi (x + time)).
std::vector<float> positions(std::uint32_t grid, double time) {
    std::vector<float> values;
    for (std::uint32_t vertex = 0; vertex < 2 * grid * grid; ++vertex) {
        const std::uint32_t local = vertex % (grid * grid);
        const double x = static_cast<double>(local % grid) / (grid - 1);
        const double z = static_cast<double>(local / grid) / (grid - 1);
        const double body = vertex < grid * grid ? 0.0 : 1.0;
        const double y = body + 0.1 * std::sin(2.0 * M_PI * (x + time));
        for (const double value : {x, y, z}) values.push_back(static_cast<float>(value));
    }
    return values;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 4) return 2;
    const std::uint32_t steps = static_cast<std::uint32_t>(std::atoi(argv[2]));
    const std::uint32_t grid = static_cast<std::uint32_t>(std::atoi(argv[3]));
    const int pause = argc > 4 ? std::atoi(argv[4]) : 0;
    const auto compression = weft::compression_named(argc > 5 ? argv[5] : "fast");
    const std::vector<Triangle> triangles = squares(grid);
    const auto half = static_cast<std::uint32_t>(triangles.size() / 2);

    weft::GeometryWriter writer(argv[1], triangles, 2 * grid * grid,
                                {{"lower", half}, {"upper & <last>", half}}, steps, compression);
    for (std::uint32_t step = 0; step < steps; ++step) {
        const double time = step / 60.0;
        writer.append(time, positions(grid, time));
        if (pause > 0) {
            std::cout << step << std::endl;
            std::this_thread::sleep_for(std::chrono::milliseconds(pause));
        }
    }
    writer.finish();
}
