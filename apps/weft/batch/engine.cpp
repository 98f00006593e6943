#include "apps/weft/batch/engine.h"

#include <cstdlib>

namespace weft::batch {

namespace {

std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? "" : value;
}

std::string joined(const std::string& job, const std::string& task) {
    return task.empty() ? job : job + "_" + task;
}

}  // namespace

Engine this_engine() {
    if (const std::string job = variable("SLURM_ARRAY_JOB_ID"); !job.empty()) {
        return {"slurm", joined(job, variable("SLURM_ARRAY_TASK_ID"))};
    }
    if (const std::string job = variable("SLURM_JOB_ID"); !job.empty()) return {"slurm", job};
    if (const std::string job = variable("HQ_JOB_ID"); !job.empty()) {
        return {"hyperqueue", joined(job, variable("HQ_TASK_ID"))};
    }
    if (const std::string job = variable("PARALLEL_SEQ"); !job.empty()) return {"parallel", job};
    return {};
}

}  // namespace weft::batch
