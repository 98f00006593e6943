// A task that does not say what it reads or writes goes unnoticed where devices share a memory and
// happen to be in time. Here every solver's tasks are held to what their kernels' parameters say.

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "simulation/scene/read_scene.h"
#include "simulation/solver/solver.h"
#include "tests/simulation/run/test_scenes.h"

namespace weft::test {
namespace {

using Buffers = std::set<const BufferStorage*>;

bool writes(const Launch& launch, std::size_t parameter) {
    using kernels::Parameter;
    const Parameter p = launch.kernel->parameters[parameter];
    return p == Parameter::kWriteFloat || p == Parameter::kWriteInt || p == Parameter::kWriteFloat4;
}

/// visit(buffer, whether it is written, the kernel's name) for each buffer that a body touches.
template <class Visit>
void for_each_buffer(const TaskBody& body, Visit visit) {
    for (const Launch& launch : body.launches) {
        for (std::size_t k = 0; k < launch.arguments.size(); ++k) {
            const BufferStorage* buffer = launch.arguments[k].buffer;
            if (buffer != nullptr) visit(*buffer, writes(launch, k), launch.kernel->name);
        }
    }
}

/// What kernels change: all else is made by the host, and the same on all devices.
Buffers changing(const Solver& solver) {
    Buffers buffers;
    for (const TaskBody* body : solver.bodies()) {
        for_each_buffer(*body, [&](const BufferStorage& buffer, bool written, auto) {
            if (written) buffers.insert(&buffer);
        });
    }
    return buffers;
}

Buffers declared(const Step& step) {
    Buffers buffers;
    for (const Task& task : step.tasks()) {
        for (const Access& access : task.accesses) buffers.insert(access.buffer);
    }
    return buffers;
}

/// Of this one, JPGD keeps the rows of the Hessian for later tasks; the rows of the gradient are
/// scratch, which every task writes for itself.
const std::string kPartlyScratch = "derivatives";

bool declares(const Task& task, const BufferStorage& buffer, bool written) {
    return std::ranges::any_of(task.accesses, [&](const Access& access) {
        return access.buffer == &buffer && (access.writes || !written);
    });
}

/// Scratch is declared nowhere; a task has to fill it before it reads it.
void expect_filled_first(const Task& task, const Buffers& scratch) {
    Buffers filled;
    for_each_buffer(*task.body, [&](const BufferStorage& buffer, bool written, auto kernel) {
        if (!scratch.contains(&buffer)) return;
        EXPECT_TRUE(written || filled.contains(&buffer))
            << kernel << " reads " << buffer.name() << " in task " << task.body->name;
        filled.insert(&buffer);
    });
}

class Accesses : public testing::TestWithParam<std::tuple<Method, const std::string*>> {};

TEST_P(Accesses, AreDeclaredForAllThatLaunchesTouch) {
    const auto [method, text] = GetParam();
    Scene scene = parse_scene(*text, "test.toml");
    scene.solver.method = method;
    Warnings warnings;
    Model model(scene, warnings);
    const auto solver = make_solver(model);
    const int strips = model.strips.count();
    const Step step = solver->make_step(Partition::at(std::vector{strips / 2}, strips));
    const Buffers changed = changing(*solver);
    Buffers scratch = changed;
    for (const BufferStorage* buffer : declared(step)) scratch.erase(buffer);
    for (const Task& task : step.tasks()) {
        expect_filled_first(task, scratch);
        for_each_buffer(*task.body, [&](const BufferStorage& buffer, bool written, auto kernel) {
            if (!changed.contains(&buffer) || scratch.contains(&buffer)) return;
            const bool must_write = written && buffer.name() != kPartlyScratch;
            EXPECT_TRUE(declares(task, buffer, must_write))
                << "task " << task.body->name << ": " << kernel
                << (written ? " writes " : " reads ") << buffer.name();
        });
    }
    EXPECT_TRUE(changed.contains(model.positions.get()));
    EXPECT_FALSE(scratch.contains(model.positions.get()));
}

std::string name_of_case(
    const testing::TestParamInfo<std::tuple<Method, const std::string*>>& given) {
    const auto [method, text] = given.param;
    const char* scene = text == &kEverything ? "Cloth"
                        : text == &kSolids   ? "Solids"
                        : text == &kWoven    ? "Woven"
                        : text == &kTouching ? "Touching"
                        : text == &kSheets   ? "Sheets"
                        : text == &kNarrow   ? "Narrow"
                        : text == &kSewn     ? "Sewn"
                                             : "NarrowTouching";
    return std::string(name_of(method)) + scene;
}

INSTANTIATE_TEST_SUITE_P(
    Solvers, Accesses,
    testing::Combine(testing::Values(Method::kXpbd, Method::kVbd, Method::kSosd, Method::kJpgd,
                                     Method::kNewton),
                     testing::Values(&kEverything, &kSolids, &kWoven, &kSewn, &kNarrow)),
    name_of_case);
INSTANTIATE_TEST_SUITE_P(InContact, Accesses,
                         testing::Combine(testing::Values(Method::kXpbd, Method::kVbd,
                                                          Method::kSosd, Method::kJpgd,
                                                          Method::kNewton),
                                          testing::Values(&kTouching, &kSheets, &kNarrowTouching)),
                         name_of_case);

}  // namespace
}  // namespace weft::test
