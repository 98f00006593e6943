#include "simulation/model/obstacles.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "kernels/obstacles/shapes.h"
#include "simulation/scene/obstacle_shapes.h"

namespace weft::test {
namespace {

TEST(Obstacles, ShapesOfScenesAreThoseThatHaveKernels) {
    std::set<std::string> with_kernels;
#define WEFT_ADD_NAME(shape) with_kernels.insert(#shape);
    WEFT_FOR_EACH_OBSTACLE_SHAPE(WEFT_ADD_NAME)
#undef WEFT_ADD_NAME
    std::set<std::string> in_scenes;
    for (const ObstacleShape& shape : obstacle_shapes()) in_scenes.insert(shape.name);
    EXPECT_EQ(in_scenes, with_kernels);
}

}  // namespace
}  // namespace weft::test
