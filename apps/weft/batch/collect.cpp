#include "apps/weft/batch/collect.h"

#include <fmt/format.h>

#include "apps/weft/batch/results_file.h"
#include "apps/weft/batch/results_table.h"
#include "runtime/io/whole_file.h"

namespace weft::batch {

Collected collect(const std::filesystem::path& folder, const Manifest& manifest, bool dropped) {
    const std::vector<Listed> runs = list_runs(folder, manifest, dropped);
    const ResultsTable table = results_table(folder, runs);
    Collected collected{manifest.name, count_states(runs), {}, hash_differences(table, runs)};

    const auto csv = folder / "results.csv", h5 = folder / "results.h5";
    write_whole_file(csv, to_csv(table));
    write_results_file(h5, table, folder, runs);
    collected.files = {csv.string(), h5.string()};
    return collected;
}

std::string to_text(const Collected& collected) {
    std::string text = fmt::format("{}: {}\n", collected.name, counts_text(collected.counts));
    for (const std::string& file : collected.files) text += file + '\n';
    return text;
}

nlohmann::ordered_json to_json(const Collected& collected) {
    Value counts = Value::object();
    for (const State state : all_states()) {
        const auto at = collected.counts.states.find(state);
        counts[name_of(state)] = at == collected.counts.states.end() ? 0 : at->second;
    }
    return {{"name", collected.name},
            {"counts", counts},
            {"warned", collected.counts.warned},
            {"differences", collected.differences},
            {"files", collected.files}};
}

}  // namespace weft::batch
