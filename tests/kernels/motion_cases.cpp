#include "kernels/motion.h"

#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

constexpr int kSubsteps = 3;
constexpr float kStep = 1.0f / 600.0f;

struct Bodies {
    Buffer<float4>& positions;
    Buffer<float4>& previous;
    Buffer<float4>& velocities;
    Buffer<float4>& gravity;

    explicit Bodies(KernelCase& c)
        : positions(c.add<float4>("positions", c.items)),
          previous(c.add<float4>("previous", c.items)),
          velocities(c.add<float4>("velocities", c.items)),
          gravity(c.add<float4>("gravity", kSubsteps)) {
        const float speed = c.flavour == Flavour::kRandom ? 10.0f : 0.0f;
        for (std::size_t v = 0; v < positions.count(); ++v) {
            positions[v] = c.random.point(1.0f);
            positions[v].w = c.random.integer(0, 3) == 0 ? 0.0f : c.random.real(0.1f, 1e4f);
            previous[v] = c.flavour == Flavour::kRandom ? c.random.point(1.0f) : positions[v];
            velocities[v] = c.random.point(speed);
            velocities[v].w = c.random.real(0.5f, 1.0f);
        }
        for (float4& g : gravity.span()) g = c.random.point(speed);
    }
};

void predict_case(KernelCase& c) {
    Bodies b(c);
    c.launch = launch(kernels::predict, c.segments, b.positions, b.previous, b.velocities,
                      b.gravity, kStep, kInstance);
}

void update_case(KernelCase& c) {
    Bodies b(c);
    c.launch = launch(kernels::update_velocities, c.segments, b.positions, b.previous, b.velocities,
                      b.gravity, kStep, 1.0f / kStep, kInstance);
}

void update_damped_case(KernelCase& c) {
    Bodies b(c);
    c.launch = launch(kernels::update_damped_velocities, c.segments, b.positions, b.previous,
                      b.velocities, b.gravity, kStep, 1.0f / kStep, kInstance);
}

void move_pins_case(KernelCase& c) {
    constexpr int kGroups = 2;
    auto& positions = c.add<float4>("positions", 2 * c.items);
    auto& vertices = c.add<int>("vertices", c.items);
    auto& rest = c.add<float4>("rest", c.items);
    auto& motions = c.add<float4>("motions", kSubsteps * 3 * kGroups);
    const std::vector<int> order = c.random.permutation(2 * c.items);
    for (std::size_t i = 0; i < vertices.count(); ++i) {
        vertices[i] = order[i];
        rest[i] = c.random.point(1.0f);
    }
    for (float4& row : motions.span()) {
        row = c.random.point(c.flavour == Flavour::kRandom ? 1.0f : 0.0f);
        row.w = c.random.real(-1.0f, 1.0f);
    }
    c.launch = launch(kernels::move_pins, c.segments, positions, vertices, rest, motions, kGroups,
                      1, kInstance);
}

void move_between_case(KernelCase& c) {
    auto& positions = c.add<float4>("positions", 2 * c.items);
    auto& vertices = c.add<int>("vertices", c.items);
    auto& ends = c.add<float4>("ends", 2 * c.items);
    const std::vector<int> order = c.random.permutation(2 * c.items);
    for (std::size_t i = 0; i < vertices.count(); ++i) vertices[i] = order[i];
    for (float4& end : ends.span()) end = c.random.point(1.0f);
    c.launch = launch(kernels::move_between, c.segments, positions, vertices, ends,
                      static_cast<int>(c.items), kSubsteps, 1.0f / kSubsteps, kInstance);
}

const bool added =
    add_case("predict", predict_case) && add_case("update_velocities", update_case) &&
    add_case("update_damped_velocities", update_damped_case) &&
    add_case("move_pins", move_pins_case) && add_case("move_between", move_between_case);

}  // namespace
}  // namespace weft::test
