#include "apps/weft/studies/stability/parts.h"

#include <algorithm>

#include "apps/weft/studies/stability/stability_study.h"
#include "runtime/error.h"

namespace weft::stability {

namespace {

using Json = nlohmann::ordered_json;

Json outcome_json(const Row& row) {
    const Outcome& o = row.outcome;
    return {{"case", full_name(row.what)},
            {"solver", o.solver},
            {"verdict", name_of(o.verdict)},
            {"reported", o.is_reported},
            {"frame", o.frame},
            {"said", o.said},
            {"why", o.why},
            {"strain_rms", o.strain_rms},
            {"strain_max", o.strain_max},
            {"ms_per_frame", o.ms_per_frame}};
}

Verdict verdict_named(const std::string& name) {
    const auto at = std::ranges::find(kVerdicts, name, name_of);
    if (at == std::end(kVerdicts)) throw UserError("no verdict is called '" + name + "'");
    return *at;
}

Outcome outcome_of(const Json& json) {
    Outcome o;
    o.solver = json.at("solver");
    o.verdict = verdict_named(json.at("verdict"));
    o.is_reported = json.at("reported");
    o.frame = json.at("frame");
    o.said = json.at("said");
    o.why = json.at("why");
    o.strain_rms = json.at("strain_rms");
    o.strain_max = json.at("strain_max");
    o.ms_per_frame = json.at("ms_per_frame");
    return o;
}

/// A case's rows, one for each solver that has done it.
void append_rows_of(const Case& what, const std::vector<Json>& parts, std::vector<Row>& rows) {
    for (const Json& part : parts) {
        for (const Json& row : part.at("rows")) {
            if (row.at("case") == full_name(what)) rows.push_back({what, outcome_of(row)});
        }
    }
}

std::size_t count_rows(const std::vector<Json>& parts) {
    std::size_t count = 0;
    for (const Json& part : parts) count += part.at("rows").size();
    return count;
}

Trial trial_of(const Json& json) {
    return {json.at("solver"),     json.at("substeps"),     json.at("iterations"), json.at("holds"),
            json.at("strain_rms"), json.at("ms_per_frame"), json.at("why")};
}

}  // namespace

Json to_part(const std::vector<Row>& rows) {
    Json list = Json::array();
    for (const Row& row : rows) list.push_back(outcome_json(row));
    return {{"study", kSuite}, {"rows", list}};
}

Json to_part(const Advice& advice) {
    Json json = to_json(advice);
    return {{"study", kSettings}, {"frames", advice.frames}, {"trials", json.at("trials")}};
}

std::vector<Row> join_suite_parts(const std::vector<Json>& parts) {
    std::vector<Row> rows;
    for (const Case& what : all_cases()) append_rows_of(what, parts, rows);
    if (rows.size() != count_rows(parts))
        throw UserError("this version's suite does not have all cases that were run");
    return rows;
}

Advice join_settings_parts(const std::vector<Json>& parts) {
    std::vector<Trial> trials;
    for (const Json& part : parts) {
        if (part.at("frames") != parts.front().at("frames"))
            throw UserError("the parts of this study have different numbers of frames");
        for (const Json& trial : part.at("trials")) trials.push_back(trial_of(trial));
    }
    return advice_of(std::move(trials), parts.front().at("frames"));
}

}  // namespace weft::stability
