#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "simulation/solver/solver.h"

namespace weft {

/// What simulating a scene takes, and what it does not: nothing that the scene does not name has a
/// task, kernel, buffer or dataset.
struct Inspection {
    struct Launch {
        std::string kernel;
        long items = 0;   ///< over all strips
        int colours = 0;  ///< that run one after the other on each strip
    };
    /// One kind of task. On a mixture of devices the tasks of a kind are divided further.
    struct Task {
        std::string kind;
        int per_substep = 0;  ///< on a single device
        std::vector<Launch> launches;
    };
    struct Kernel {
        std::string name;
        std::string file;
    };
    struct Buffer {
        std::string name;
        std::size_t bytes = 0;
    };
    /// A dataset of trace.h5.
    struct Dataset {
        std::string name;
        std::vector<std::string> columns;  ///< of tables
    };
    struct LeftOut {
        std::string what;
        std::string why;
        std::vector<std::string> kernels;  ///< that nobody launches for this reason
    };

    Vec3 origin;  ///< that positions in buffers count from, in the scene's own coordinates [m]
    int vertices = 0;
    int triangles = 0;
    int strips = 0;
    std::vector<Task> tasks;
    std::vector<Kernel> kernels;  ///< by name
    std::vector<Buffer> buffers;  ///< on devices, in order of first use
    std::vector<Dataset> datasets;
    std::vector<LeftOut> left_out;
};

/// Touches no device. `solver` is the model's.
Inspection inspect(const Model& model, Solver& solver);

}  // namespace weft
