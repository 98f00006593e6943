#pragma once

#include <string>

namespace weft::batch {

/// Who has started this process, as its environment says.
struct Engine {
    std::string name;  ///< "slurm", "hyperqueue", "parallel"; empty: nobody that is known
    std::string job;   ///< "1234_7"
};
Engine this_engine();

}  // namespace weft::batch
