#include "apps/weft/batch/engine_script.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/weft/batch/index_list.h"
#include "apps/weft/batch/listing.h"
#include "runtime/io/json_text.h"

namespace weft::batch {

namespace {

struct Words {
    std::string name, folder, ranges, list;
    std::string quoted;  ///< the folder, as Python writes it
    std::string task;    ///< of HyperQueue, for bash -c
};

constexpr const char* kSlurm = R"script(#!/bin/bash
# The sweep {name} as a job array; submit it from here:
#   sbatch job.sh                                    all of it, and again what was stopped
#   sbatch --array=$(weft batch {folder} --list --state waiting,stopped,lost --ranges)%50 job.sh
#SBATCH --job-name={name}
#SBATCH --array={ranges}
#SBATCH --cpus-per-task=1
#SBATCH --time=01:00:00
#SBATCH --signal=B:USR1@120
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output={folder}/slurm-%a.log

# As a child, so that this script lives on to have the job requeued: 75 means that it was stopped in
# good order, and goes on. The trap hands on what Slurm sends to the script alone.
weft batch {folder} --index "$SLURM_ARRAY_TASK_ID" &
run=$!
trap 'kill -USR1 "$run"' USR1 TERM
wait "$run"; code=$?
while [ "$code" -gt 128 ] && kill -0 "$run" 2>/dev/null; do wait "$run"; code=$?; done
[ "$code" -ne 75 ] || scontrol requeue "$SLURM_JOB_ID"
exit "$code"
)script";

constexpr const char* kParallel = R"script(#!/bin/bash
# The sweep {name} on this machine, one core each; call it again, and it goes on.
# A GPU each: parallel -j 2 ... 'CUDA_VISIBLE_DEVICES=$(({{%}}-1))' weft batch ...
weft batch {folder} --list --state waiting,stopped,lost --commands |
  parallel -j "$(nproc)" --joblog {folder}/parallel.log --termseq TERM,60000,KILL,25 \
    'taskset -c $(({{%}}-1)) bash -c {{}}'
weft batch {folder} --collect
)script";

constexpr const char* kHyperQueue = R"script(#!/bin/bash
# The sweep {name} by HyperQueue (hq server start, hq worker start):
hq submit --name {name} --array {ranges} --pin taskset --cpus 1 \
  bash -c {task}
)script";

constexpr const char* kSnakemake =
    R"script(# The sweep {name} by Snakemake: snakemake --snakefile Snakefile --cores all --keep-going
FOLDER = {quoted}
RUNS = {list}

rule all:
    input: expand(FOLDER + "/done/{{index}}", index=RUNS)
    shell: "weft batch {{FOLDER:q}} --collect"

rule run:
    output: touch(FOLDER + "/done/{{index}}")
    retries: 3
    shell: "weft batch {{FOLDER:q}} --index {{wildcards.index}}"
)script";

std::string filled(const char* form, const Words& words) {
    return fmt::format(fmt::runtime(form), fmt::arg("name", words.name),
                       fmt::arg("folder", words.folder), fmt::arg("ranges", words.ranges),
                       fmt::arg("list", words.list), fmt::arg("quoted", words.quoted),
                       fmt::arg("task", words.task));
}

/// For job names, which take no blanks.
std::string job_name(std::string name) {
    std::ranges::replace(name, ' ', '_');
    return shell_word(name);
}

}  // namespace

const std::vector<std::string>& engines() {
    static const std::vector<std::string> names{"slurm", "parallel", "hyperqueue", "snakemake"};
    return names;
}

std::string script_for(const std::string& engine, const Manifest& manifest,
                       const std::filesystem::path& folder) {
    const std::string word = shell_word(folder.string());
    const Words words{job_name(manifest.name),
                      word,
                      to_ranges(manifest.current()),
                      to_python(manifest.current()),
                      json_text(Value(folder.string()), -1),  // JSON's strings are Python's, too
                      shell_word(fmt::format("exec weft batch {} --index \"$HQ_TASK_ID\"", word))};
    if (engine == "slurm") return filled(kSlurm, words);
    if (engine == "parallel") return filled(kParallel, words);
    if (engine == "hyperqueue") return filled(kHyperQueue, words);
    return filled(kSnakemake, words);
}

}  // namespace weft::batch
