#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/weft/batch/stop_notice.h"

namespace weft::batch {

/// How a child has ended.
struct ChildEnd {
    int exit_code = 0;
    int signal = 0;  ///< that killed it; 0: it ended by itself
    bool asked_to_stop = false;
};

/// A run of the program in a process of its own: a driver that crashes takes nothing else with it.
class ChildRun {
public:
    using Work = std::function<int()>;

    /// Starts it. What it says goes to the end of `log`. Call it while this process has no threads.
    /// Throws RunError.
    ChildRun(const std::filesystem::path& log, const Work& work);

    /// Waits for its end. As soon as something asks to stop, or the deadline is there, it is asked
    /// once (SIGTERM), and killed at the second SIGINT.
    /// seconds_left  until the deadline
    ChildEnd wait(const StopNotice& notice,
                  const std::function<std::optional<double>()>& seconds_left);

private:
    pid_t process_ = -1;
};

}  // namespace weft::batch
