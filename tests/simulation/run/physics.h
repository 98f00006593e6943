#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "simulation/scene/method.h"
#include "tests/simulation/run/manual_run.h"

namespace weft::test {

/// A test of every solver: what physics says holds for all of them.
class EverySolver : public testing::TestWithParam<Method> {
protected:
    static Scene scene_of(const std::string& text);
};
std::string name_of_method(const testing::TestParamInfo<Method>& info);
inline const auto kMethods =
    testing::Values(Method::kXpbd, Method::kVbd, Method::kSosd, Method::kJpgd, Method::kNewton);

// The state in scene order, xyz after xyz.
std::vector<float> positions(const ManualRun& run);
std::vector<float> velocities(const ManualRun& run);
Vec3 at(const std::vector<float>& values, int vertex);
/// The largest distance between corresponding vertices.
double difference(const std::vector<float>& a, const std::vector<float>& b);
/// Turned by minus `degrees`.
std::vector<float> turned_back(std::vector<float> values, Vec3 axis, double degrees);

/// How far and how fast something has fallen, by the steps that the scheme takes, in double
/// precision.
struct Fall {
    Vec3 x, v;
};
Fall free_fall(const Scene& scene, double damping, int frames);

/// Of some vertices, weighted with their masses.
struct Momentum {
    double mass = 0.0;  ///< [kg]
    Vec3 place;         ///< mean [m]
    Vec3 velocity;      ///< mean [m/s]
};
/// Of the vertices [first, first + count) in scene order.
Momentum momentum_of(const ManualRun& run, int first, int count);
/// Of a body of the model.
Momentum momentum_of(const ManualRun& run, int body);

/// Of all vertices, held ones too [J].
double kinetic_energy(const ManualRun& run);

/// Runs from a state out of rest, and expects neither momentum nor angular momentum, in parts of
/// what all momenta together are like. Returns the latter [kg m/s].
double run_without_momentum(ManualRun& run, int frames, double tolerance);

}  // namespace weft::test
