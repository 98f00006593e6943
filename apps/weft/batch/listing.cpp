#include "apps/weft/batch/listing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "apps/weft/batch/drive.h"

namespace weft::batch {

namespace {

/// Below the line of a run: why it failed, and the first of its warnings.
std::string remarks(const Status& status) {
    std::string text;
    if (status.state == State::kFailed) text += fmt::format("{:>6}  {}\n", "", status.why);
    if (status.warnings.empty()) return text;
    text += fmt::format("{:>6}  warning: {}", "", status.warnings.front());
    if (status.warnings.size() > 1)
        text += fmt::format(" (and {} more)", status.warnings.size() - 1);
    return text + '\n';
}

}  // namespace

std::vector<Listed> list_runs(const std::filesystem::path& folder, const Manifest& manifest,
                              bool dropped) {
    std::vector<Listed> list;
    for (const Run& run : manifest.runs) {
        if (run.dropped && !dropped) continue;
        list.push_back({&run, RunFolder(run_path(folder, run)).status()});
    }
    return list;
}

std::vector<Listed> with_states(std::vector<Listed> runs, const std::vector<State>& states) {
    std::erase_if(runs, [&](const Listed& listed) {
        return std::ranges::find(states, listed.status.state) == states.end();
    });
    return runs;
}

std::vector<std::size_t> indices_of(const std::vector<Listed>& runs) {
    std::vector<std::size_t> indices;
    for (const Listed& listed : runs) indices.push_back(listed.run->index);
    return indices;
}

Counts count_states(const std::vector<Listed>& runs) {
    Counts counts;
    for (const auto& [run, status] : runs) {
        ++counts.states[status.state];
        counts.warned += status.state == State::kFinished && !status.warnings.empty();
    }
    return counts;
}

std::string counts_text(const Counts& counts) {
    std::string text;
    for (auto it = counts.states.rbegin(); it != counts.states.rend(); ++it) {
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", it->second, name_of(it->first));
        if (it->first == State::kFinished && counts.warned > 0)
            text += fmt::format(" ({} warned)", counts.warned);
    }
    return text.empty() ? "no runs" : text;
}

std::string values_text(const Run& run) {
    std::string text;
    for (const auto& [key, value] : run.values) {
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", key, to_text(value));
    }
    return text;
}

std::string to_table(const std::vector<Listed>& runs) {
    std::string text = fmt::format("{:>6}  {:<12}  {:<8}  {:>8}  {}\n", "run", "id", "state",
                                   "attempts", "values");
    for (const auto& [run, status] : runs) {
        text += fmt::format("{:>6}  {}  {:<8}  {:>8}  {}{}\n", run->index, run->id,
                            name_of(status.state), status.attempts, values_text(*run),
                            run->dropped ? " (dropped)" : "");
        text += remarks(status);
    }
    return text;
}

nlohmann::ordered_json to_json(const std::vector<Listed>& runs) {
    Value list = Value::array();
    for (const auto& [run, status] : runs) {
        Value values = Value::object();
        for (const auto& [key, value] : run->values) values[key] = value;
        Value entry{{"index", run->index}, {"id", run->id}, {"state", name_of(status.state)}};
        entry["exit_code"] = status.exit_code ? Value(*status.exit_code) : Value(nullptr);
        entry["attempts"] = status.attempts;
        if (!status.why.empty()) entry["why"] = status.why;
        if (!status.warnings.empty()) entry["warnings"] = status.warnings;
        if (run->dropped) entry["dropped"] = true;
        entry["values"] = std::move(values);
        list.push_back(std::move(entry));
    }
    return list;
}

std::string shell_word(const std::string& text) {
    const bool plain = !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
        return std::isalnum(c) ||
               std::string_view("_-+./:=,@%").find(static_cast<char>(c)) != std::string_view::npos;
    });
    if (plain) return text;
    std::string quoted = "'";
    for (const char c : text) {
        if (c == '\'')
            quoted += "'\\''";
        else
            quoted += c;
    }
    return quoted + "'";
}

std::string to_commands(const std::vector<Listed>& runs, const std::filesystem::path& folder) {
    std::string text;
    for (const Listed& listed : runs) {
        text += fmt::format("weft batch {} --index {}\n", shell_word(folder.string()),
                            listed.run->index);
    }
    return text;
}

}  // namespace weft::batch
