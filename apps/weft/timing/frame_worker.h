#pragma once

#include <sys/types.h>

#include <string>

#include "apps/weft/run/run_options.h"
#include "runtime/io/process.h"
#include "simulation/mesh/triangle_mesh.h"

namespace weft {

/// One frame of a worker, times in ms.
struct FrameSample {
    double wall = 0.0;  ///< all that a frame takes without output
    double planned = 0.0;
    double measured = 0.0;  ///< makespan
    double plan = 0.0;
    double utilisation = 0.0;
    bool mixed = false;  ///< several devices took part
};

struct EndState {
    std::string hash;
    bool is_async = false;  ///< the state depends on how the devices share the work
    double energy = 0.0;    ///< [J]
    Warnings warnings;      ///< what `weft run` would have warned of, or stopped at
};

/// A simulation in a process of its own, which does one frame whenever it is told to. In between it
/// only waits, with all of its threads: so several device lists can take turns, frame by frame,
/// without disturbing each other, and drivers that are set up once per process can be set up for
/// each.
class FrameWorker {
public:
    /// Starts the process, which sets up the scene. Call before this process uses any thread.
    explicit FrameWorker(const RunOptions& options);
    ~FrameWorker();
    FrameWorker(const FrameWorker&) = delete;
    FrameWorker& operator=(const FrameWorker&) = delete;

    /// Waits until the scene is set up. Throws UserError or RunError, as the worker met it.
    void wait_until_ready();
    FrameSample advance();
    EndState end_state();

    const std::string& devices() const { return devices_; }

private:
    std::string ask(char command);
    void serve(const RunOptions& options);  // in the worker

    std::string devices_;
    Pipe commands_;
    Pipe answers_;
    pid_t process_ = -1;
};

}  // namespace weft
