// A run on the CPU initialises no OpenCL platform. This program's own clGetPlatformIDs() stands
// before that of the OpenCL library, and counts.

#include <CL/cl.h>
#include <dlfcn.h>
#include <gtest/gtest.h>

#include "runtime/device_list.h"
#include "runtime/executor.h"
#include "tests/runtime/random_tasks.h"

namespace {
int platform_queries = 0;
}

extern "C" cl_int clGetPlatformIDs(cl_uint count, cl_platform_id* platforms, cl_uint* available) {
    ++platform_queries;
    using Function = cl_int (*)(cl_uint, cl_platform_id*, cl_uint*);
    static const auto real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "clGetPlatformIDs"));
    return real(count, platforms, available);
}

namespace weft::test {
namespace {

TEST(NoOpenCl, IsTouchedForACpu) {
    for (const char* list : {"cpu", "cpu/1"}) {
        const auto devices = open_devices(list);
        RandomTasks tasks;
        Executor executor({devices.front().get()}, tasks.bodies());
        Random random(1);
        const Step step = tasks.make_step(random, 10);
        executor.run(step, random_plan(step, 1, random), 2);
    }
    EXPECT_THROW(open_devices("gpx"), std::exception);
    EXPECT_EQ(platform_queries, 0);
}

TEST(NoOpenCl, QueryWouldHaveBeenCounted) {
    available_devices();
    EXPECT_GT(platform_queries, 0);
}

}  // namespace
}  // namespace weft::test
