#include "simulation/scene/body_keys.h"

namespace weft {
namespace {

const Range kTime = between(0.0, 1e9);

const TableKeys& keyframe_table() {
    static const TableKeys table{{
        {.name = "time",
         .help = "time since the start",
         .unit = "s",
         .required = true,
         .range = kTime},
        {.name = "translate",
         .forms = {{3}},
         .help = "displacement from the place at the start",
         .unit = "m",
         .fallback = std::vector<double>{0, 0, 0},
         .range = kPlace},
        {.name = "rotate",
         .help = "angle about the axis",
         .unit = "degrees",
         .fallback = 0.0,
         .range = between(-1e9, 1e9)},
        {.name = "axis",
         .forms = {{3}},
         .help = "axis of this turn, any length; default: the motion's. Between two axes the turn "
                 "goes the shortest way"},
    }};
    return table;
}

const TableKeys& motion_table() {
    static const TableKeys table{{
        {.name = "velocity",
         .forms = {{3}},
         .help = "constant velocity; or use keyframes",
         .unit = "m/s",
         .range = between(-1e4, 1e4)},
        {.name = "angular_velocity",
         .help = "constant rate of turn; or use keyframes",
         .unit = "degrees/s",
         .range = between(-1e6, 1e6)},
        {.name = "axis",
         .forms = {{3}},
         .help = "axis of the turn; any length",
         .fallback = std::vector<double>{0, 1, 0}},
        {.name = "center",
         .forms = {{3}},
         .help = "point that the axis goes through, at the start; default: the obstacle's own "
                 "centre, for pins the origin",
         .unit = "m",
         .range = kPlace},
        {.name = "keyframes",
         .type = Type::kTable,
         .forms = {{kAny}},
         .help = "by rising time; linear between, held before the first and after the last",
         .table = &keyframe_table()},
        {.name = "frames",
         .type = Type::kText,
         .help = "of a mesh obstacle, instead of all else: OBJ files of the same vertices, as in "
                 "body_*.obj, or an HDF5 file of points (frames, vertices, 3), as in body.h5 or "
                 "body.h5:/path/of/dataset, relative to the scene file; the first is the start, "
                 "linear between"},
        {.name = "frame_time",
         .help = "time between two of these frames; default: one frame of the scene",
         .unit = "s",
         .range = positive_up_to(1e6)},
    }};
    return table;
}

}  // namespace

Key motion_key(std::string help) {
    return {
        .name = "motion", .type = Type::kTable, .help = std::move(help), .table = &motion_table()};
}

}  // namespace weft
