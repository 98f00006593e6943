#include "apps/weft/batch/results_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "apps/weft/batch/drive.h"
#include "apps/weft/output/csv_text.h"

namespace weft::batch {

namespace {

constexpr const char* kHash = "state_hash";

// Of summary.json; its other numbers follow.
const std::vector<std::string>& first_results() {
    static const std::vector<std::string> names{"frames", "ms_per_frame", "ms_p95", "energy",
                                                kHash};
    return names;
}

using Numbers = std::vector<std::pair<std::string, Value>>;

void add_numbers(const Value& object, const std::string& prefix, Numbers& numbers) {
    for (const auto& [key, value] : object.items()) {
        if (value.is_number()) numbers.emplace_back(prefix + key, value);
        if (value.is_object()) add_numbers(value, prefix + key + '.', numbers);
    }
}

/// Of a summary, those in tables by dotted names: contact.pairs.
Numbers numbers_of(const Value& summary) {
    Numbers numbers;
    add_numbers(summary, "", numbers);
    return numbers;
}

Value member(const Value& object, const std::string& key) {
    return object.contains(key) ? object[key] : Value(nullptr);
}

/// By what became of it: --plan auto may take such a plan, and --plan async may have one device.
bool is_asynchronous(const Value& summary) {
    const Value settings = member(summary, "settings");
    return settings.is_object() && settings.contains("async");
}

std::string device_names(const Value& summary) {
    std::vector<std::string> names;
    if (!summary.contains("devices") || !summary["devices"].is_array()) return "";
    for (const Value& device : summary["devices"]) names.push_back(device.value("name", ""));
    return fmt::format("{}", fmt::join(names, " + "));
}

/// Columns in the order in which they are met first.
class Columns {
public:
    void add(const std::string& name) {
        if (seen_.insert(name).second) names_.push_back(name);
    }
    std::vector<std::string> take() { return std::move(names_); }

private:
    std::vector<std::string> names_;
    std::set<std::string> seen_;
};

std::vector<std::string> columns_of(const std::vector<Listed>& runs,
                                    const std::vector<Value>& summaries) {
    Columns columns;
    for (const char* name : {"index", "id"}) columns.add(name);
    for (const Listed& listed : runs) {
        for (const auto& [key, value] : listed.run->values) columns.add(key);
    }
    for (const char* name : {"state", "exit_code", "attempts", "warnings"}) columns.add(name);
    for (const std::string& name : first_results()) columns.add(name);
    for (const char* name : {"wall_s", "host", "cores", "devices", "weft", "job"})
        columns.add(name);
    for (const Value& summary : summaries) {
        for (const auto& [name, number] : numbers_of(summary)) columns.add(name);
    }
    for (const char* name : {"first_warning", "why"}) columns.add(name);
    return columns.take();
}

/// By column. The axes' values come last, and win.
std::map<std::string, Value> cells_of(const Listed& listed, const Value& summary) {
    const auto& [run, status] = listed;
    std::map<std::string, Value> cells;
    for (const auto& [name, number] : numbers_of(summary)) cells[name] = number;
    cells[kHash] = member(summary, kHash);
    cells["index"] = run->index;
    cells["id"] = run->id;
    cells["state"] = name_of(status.state);
    cells["exit_code"] = status.exit_code ? Value(*status.exit_code) : Value(nullptr);
    cells["attempts"] = status.attempts;
    cells["warnings"] = status.warnings.size();
    cells["first_warning"] = status.warnings.empty() ? "" : status.warnings.front();
    cells["wall_s"] = status.wall;
    cells["host"] = status.host;
    cells["cores"] = status.cores;
    cells["devices"] = device_names(summary);
    cells["weft"] = status.weft;
    cells["job"] = status.job;
    cells["why"] = status.why;
    for (const auto& [key, value] : run->values) cells[key] = value;
    return cells;
}

std::string cell_of(const Value& value) { return value.is_null() ? "" : csv_cell(to_text(value)); }

template <class List>
std::string csv_line(const List& cells) {
    std::string line;
    for (std::size_t i = 0; i < cells.size(); ++i) line += (i > 0 ? "," : "") + cell_of(cells[i]);
    return line + '\n';
}

/// What a run's result may depend on.
std::string origin_of(const Run& run) {
    std::string text = run.scene_hash;
    for (std::size_t i = 0; i < run.arguments.size(); ++i) {
        const std::string& word = run.arguments[i];
        if (word == "--set" || word == "--math" || word == "--on-trouble" ||
            word == "--on-crossing")
            text += '\n' + word + ' ' + run.arguments.at(i + 1);
    }
    return text;
}

}  // namespace

ResultsTable results_table(const std::filesystem::path& folder, const std::vector<Listed>& runs) {
    std::vector<Value> summaries;
    for (const Listed& listed : runs) {
        summaries.push_back(RunFolder(run_path(folder, *listed.run)).read_summary());
    }
    ResultsTable table{columns_of(runs, summaries), {}, {}};
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const auto cells = cells_of(runs[i], summaries[i]);
        std::vector<Value> row;
        for (const std::string& column : table.columns) {
            const auto cell = cells.find(column);
            row.push_back(cell == cells.end() ? Value(nullptr) : cell->second);
        }
        table.rows.push_back(std::move(row));
        table.is_async.push_back(is_asynchronous(summaries[i]));
    }
    return table;
}

std::string to_csv(const ResultsTable& table) {
    std::string text = csv_line(table.columns);
    for (const auto& row : table.rows) text += csv_line(row);
    return text;
}

std::vector<std::string> hash_differences(const ResultsTable& table,
                                          const std::vector<Listed>& runs) {
    const auto at =
        static_cast<std::size_t>(std::ranges::find(table.columns, kHash) - table.columns.begin());
    std::map<std::string, std::map<std::string, std::vector<std::size_t>>> groups;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const Value& hash = table.rows[i][at];
        if (runs[i].status.state != State::kFinished || !hash.is_string()) continue;
        if (table.is_async[i]) continue;
        groups[origin_of(*runs[i].run)][hash.get<std::string>()].push_back(runs[i].run->index);
    }
    std::vector<std::string> notes;
    for (const auto& [origin, hashes] : groups) {
        if (hashes.size() < 2) continue;
        std::string text = "runs that differ in devices, plan or repeat only have several results:";
        for (const auto& [hash, indices] : hashes) {
            text += fmt::format(" {} ({:.8})", fmt::join(indices, ", "), hash);
        }
        notes.push_back(text);
    }
    return notes;
}

}  // namespace weft::batch
