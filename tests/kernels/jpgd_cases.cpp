#include "kernels/descent/energy_terms.h"
#include "kernels/descent/hinges.h"
#include "kernels/descent/membranes.h"
#include "kernels/descent/springs.h"
#include "kernels/descent/tetrahedra.h"
#include "kernels/jpgd/contacts.h"
#include "kernels/jpgd/control.h"
#include "kernels/jpgd/step.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Buffer<float4>& add_points(KernelCase& c, const std::string& name, int count) {
    auto& points = c.add<float4>(name, count);
    for (float4& x : points.span()) {
        x = c.random.point(c.flavour == Flavour::kRandom ? 1.0f : 0.0f);
        x.w = c.random.integer(0, 5) == 0 ? 0.0f : c.random.real(0.1f, 1e4f);
    }
    return points;
}

Buffer<float>& add_reals(KernelCase& c, const std::string& name, int count, float low, float high) {
    auto& reals = c.add<float>(name, count);
    for (float& value : reals.span()) value = c.random.real(low, high);
    return reals;
}

Buffer<int>& add_corners(KernelCase& c, int arity) {
    auto& corners = c.add<int>("corners", arity * c.items);
    for (int& v : corners.span()) v = c.random.integer(0, 2 * c.items - 1);
    return corners;
}

/// Places side by side, behind some others.
Buffer<int>& add_slots(KernelCase& c) {
    auto& slots = c.add<int>("slots", c.items);
    for (int i = 0; i < c.items; ++i) slots[at(i)] = i + 5;
    return slots;
}

void spring_terms_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", 2 * c.items);
    auto& ends = add_corners(c, 2);
    auto& material = add_reals(c, "material", 2 * c.items, 0.1f, 2.0f);
    auto& slots = add_slots(c);
    auto& terms = c.add<float>("terms", c.items + 9);
    c.launch =
        launch(kernels::spring_terms, c.segments, positions, ends, material, slots, terms, c.items);
}

void hinge_terms_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", 2 * c.items);
    auto& corners = add_corners(c, 4);
    auto& weights = add_reals(c, "weights", 4 * c.items, -1.0f, 1.0f);
    auto& slots = add_slots(c);
    auto& terms = c.add<float>("terms", c.items + 9);
    c.launch = launch(kernels::hinge_terms, c.segments, positions, corners, weights, slots, terms,
                      c.items);
}

template <class Kernel>
void elastic_terms_case(KernelCase& c, Kernel kernel, int arity, int shape_columns) {
    auto& positions = add_points(c, "positions", 2 * c.items);
    auto& corners = add_corners(c, arity);
    auto& shape = add_reals(c, "shape", shape_columns * c.items, -3.0f, 3.0f);
    auto& material = add_reals(c, "material", 2 * c.items, 0.1f, 2.0f);
    auto& slots = add_slots(c);
    auto& terms = c.add<float>("terms", c.items + 9);
    c.launch =
        launch(kernel, c.segments, positions, corners, shape, material, slots, terms, c.items);
}

void membrane_terms_case(KernelCase& c) { elastic_terms_case(c, kernels::membrane_terms, 3, 4); }
void tetrahedron_terms_case(KernelCase& c) {
    elastic_terms_case(c, kernels::tetrahedron_terms, 4, 9);
}

void inertia_terms_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    auto& targets = add_points(c, "targets", c.items);
    auto& slots = add_slots(c);
    auto& terms = c.add<float>("terms", c.items + 9);
    c.launch = launch(kernels::inertia_terms, c.segments, positions, targets, slots, terms, 1e4f);
}

void add_terms_case(KernelCase& c) {
    constexpr int kRows = 4;
    auto& terms = add_reals(c, "terms", kRows * c.items, 0.0f, 1.0f);
    auto& columns = c.add<int>("columns", 2 * c.items);
    for (int i = 0; i < c.items; ++i) {
        columns[at(2 * i)] = i;
        columns[at(2 * i + 1)] = kRows;
    }
    auto& sums = c.add<float>("sums", c.items);
    c.launch = launch(kernels::add_terms, c.segments, terms, columns, sums, c.items);
}

Buffer<float>& add_control(KernelCase& c) {
    auto& control = c.add<float>("control", WEFT_CONTROL_SIZE);
    control[WEFT_STEP_SIZE] = control[WEFT_LAST_SIZE] = 0.3f;
    control[WEFT_START] = 1.0f;
    control[WEFT_ENERGY] = c.random.real(0.0f, 1.0f);
    control[WEFT_REVERT] = c.items % 2 == 0 ? 1.0f : 0.0f;
    return control;
}

void decide_case(KernelCase& c) {
    auto& control = add_control(c);
    auto& partials = add_reals(c, "partials", 100, 0.0f, 0.01f);
    c.launch = launch(kernels::decide_step, c.segments, control, partials, 100, 1.5f, c.items % 3);
}

void revert_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    auto& kept = add_points(c, "kept", c.items);
    auto& control = add_control(c);
    c.launch = launch(kernels::keep_or_revert, c.segments, positions, kept, control);
}

/// What both kinds of steps take.
struct StepCase {
    Buffer<float4>&positions, &next, &residue, &next_residue, &targets;
    Buffer<float>&sums, &control, &weights;

    explicit StepCase(KernelCase& c)
        : positions(add_points(c, "positions", c.items)),
          next(add_points(c, "next", c.items)),
          residue(add_points(c, "residue", c.items)),
          next_residue(add_points(c, "next_residue", c.items)),
          targets(add_points(c, "targets", c.items)),
          sums(add_reals(c, "sums", 9 * c.items, 0.0f, 1.0f)),
          control(add_control(c)),
          weights(c.add<float>("weights", 3)) {
        weights[0] = 1.0f;
        weights[1] = 1.5f;
        weights[2] = 1.8f;
    }
};

void step_case(KernelCase& c) {
    StepCase s(c);
    c.launch = launch(kernels::step_preconditioned, c.segments, s.positions, s.next, s.residue,
                      s.next_residue, s.targets, s.sums, s.control, s.weights, c.items, 1e2f,
                      1 + c.items % 3);
}

Buffer<int>& add_zeros_and_ones(KernelCase& c, const std::string& name) {
    auto& values = c.add<int>(name, c.items);
    for (int& value : values.span()) value = c.random.integer(0, 1);
    return values;
}

void step_beside_contacts_case(KernelCase& c) {
    StepCase s(c);
    auto& counts = add_zeros_and_ones(c, "counts");
    c.launch = launch(kernels::step_beside_contacts, c.segments, s.positions, s.next, s.residue,
                      s.next_residue, s.targets, s.sums, s.control, s.weights, counts, c.items,
                      1e2f, 1 + c.items % 3);
}

void bound_case(KernelCase& c) {
    StepCase s(c);
    c.launch = launch(kernels::bound_elements, c.segments, s.sums, s.control, c.items);
}

void drop_case(KernelCase& c) {
    auto& cut = add_zeros_and_ones(c, "cut");
    auto& residue = add_points(c, "residue", c.items);
    c.launch = launch(kernels::drop_residues, c.segments, cut, residue);
}

const bool added =
    add_case("spring_terms", spring_terms_case) && add_case("hinge_terms", hinge_terms_case) &&
    add_case("membrane_terms", membrane_terms_case) &&
    add_case("tetrahedron_terms", tetrahedron_terms_case) &&
    add_case("inertia_terms", inertia_terms_case) && add_case("add_terms", add_terms_case) &&
    add_case("decide_step", decide_case) && add_case("keep_or_revert", revert_case) &&
    add_case("step_preconditioned", step_case) &&
    add_case("step_beside_contacts", step_beside_contacts_case) &&
    add_case("bound_elements", bound_case) && add_case("drop_residues", drop_case);

}  // namespace
}  // namespace weft::test
