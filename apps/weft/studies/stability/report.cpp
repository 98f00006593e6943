#include "apps/weft/studies/stability/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/weft/output/csv_text.h"

namespace weft::stability {

namespace {

std::vector<std::string> distinct(const std::vector<Row>& rows, auto value) {
    std::vector<std::string> list;
    for (const Row& row : rows) {
        if (std::ranges::find(list, value(row)) == list.end()) list.push_back(value(row));
    }
    return list;
}

std::string counts(const std::vector<Row>& rows, const std::string& group,
                   const std::string& solver) {
    std::string line = fmt::format("{:<16} {:<8}", group, solver);
    int silent = 0;
    for (const Verdict verdict : kVerdicts) {
        const auto count = std::ranges::count_if(rows, [&](const Row& row) {
            return row.what.group == group && row.outcome.solver == solver &&
                   row.outcome.verdict == verdict;
        });
        line += fmt::format("{:>12}", count);
    }
    for (const Row& row : rows) {
        if (row.what.group == group && row.outcome.solver == solver && row.outcome.is_silent())
            ++silent;
    }
    return line + fmt::format("{:>16}\n", silent);
}

}  // namespace

std::string to_csv(const std::vector<Row>& rows) {
    std::string text =
        "group,case,solver,verdict,reported,frame,strain_rms,strain_max,ms_per_frame,across,up,"
        "iterations,criterion,why,said\n";
    for (const Row& row : rows) {
        const Outcome& o = row.outcome;
        text += fmt::format("{},{},{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{},{},{},{}\n",
                            csv_cell(row.what.group), csv_cell(row.what.name), o.solver,
                            name_of(o.verdict), o.is_reported ? "yes" : "no", o.frame, o.strain_rms,
                            o.strain_max, o.ms_per_frame, row.what.across, row.what.up,
                            row.what.iterations, csv_cell(text_of(row.what.criterion)),
                            csv_cell(o.why), csv_cell(o.said));
    }
    return text;
}

nlohmann::ordered_json to_json(const std::vector<Row>& rows) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Row& row : rows) {
        const Outcome& o = row.outcome;
        list.push_back({{"group", row.what.group},
                        {"case", row.what.name},
                        {"solver", o.solver},
                        {"verdict", name_of(o.verdict)},
                        {"reported", o.is_reported},
                        {"frame", o.frame},
                        {"strain_rms", o.strain_rms},
                        {"strain_max", o.strain_max},
                        {"ms_per_frame", o.ms_per_frame},
                        {"criterion", text_of(row.what.criterion)},
                        {"why", o.why},
                        {"said", o.said}});
    }
    return list;
}

std::string to_text(const std::vector<Row>& rows) {
    std::string text = fmt::format("{:<16} {:<8}", "group", "solver");
    for (const Verdict verdict : kVerdicts) text += fmt::format("{:>12}", name_of(verdict));
    text += fmt::format("{:>16}\n", "without a word");
    const auto solvers = distinct(rows, [](const Row& row) { return row.outcome.solver; });
    for (const auto& group : distinct(rows, [](const Row& row) { return row.what.group; })) {
        for (const auto& solver : solvers) text += counts(rows, group, solver);
    }
    for (const Row& row : rows) {
        if (!row.outcome.is_silent()) continue;
        text += fmt::format("without a word: {}, {}, {}: {} ({})\n", row.what.group, row.what.name,
                            row.outcome.solver, name_of(row.outcome.verdict), row.outcome.why);
    }
    return text;
}

}  // namespace weft::stability
