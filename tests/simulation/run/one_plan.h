#pragma once

#include <string>

#include "simulation/simulation.h"

namespace weft::test {

/// A simulation by one plan: nothing is calibrated or planned anew.
inline Simulation simulation_of(const Scene& scene, OnTrouble on_trouble = OnTrouble::kStop,
                                const std::string& devices = "cpu/1") {
    Warnings warnings;
    SimulationOptions options;
    options.devices = devices;
    options.calibrate = false;
    options.plan = PlanKind::kSingle;
    options.on_trouble = on_trouble;
    return {scene, options, warnings};
}

}  // namespace weft::test
