#include "apps/weft/batch/collect_study.h"

#include <fstream>

#include "apps/weft/batch/drive.h"
#include "apps/weft/studies/stability/parts.h"
#include "apps/weft/studies/study_files.h"
#include "apps/weft/studies/study_parts.h"
#include "runtime/error.h"

namespace weft::batch {

namespace {

/// One that has failed may have measured something before it did, or by doing so.
bool may_have_part(const Status& status) {
    return status.state == State::kFinished || status.state == State::kFailed;
}

std::vector<Value> parts_of(const std::filesystem::path& folder, const Manifest& manifest) {
    std::vector<Value> parts;
    for (const Listed& listed : list_runs(folder, manifest, false)) {
        if (!may_have_part(listed.status)) continue;
        const auto path = run_path(folder, *listed.run) / "study.json";
        std::ifstream file(path);
        if (!file && listed.status.state == State::kFailed) continue;
        const Value part = Value::parse(file, nullptr, /*allow_exceptions=*/false);
        if (!part.is_object()) throw RunError(path.string() + ": cannot be read");
        parts.push_back(part);
    }
    return parts;
}

/// What was written, for people.
std::string write_joined(const std::filesystem::path& folder, const std::vector<Value>& parts) {
    const std::string kind = parts.front().value("study", "");
    if (kind == stability::kSuite) return write_study(folder, stability::join_suite_parts(parts));
    if (kind == stability::kSettings) {
        const stability::Advice advice = stability::join_settings_parts(parts);
        return to_text(advice) + write_study(folder, advice);
    }
    if (is_trajectory_part(parts.front())) return write_study(folder, join_trajectory_parts(parts));
    return write_study(folder, join_error_parts(parts));
}

}  // namespace

void collect_study(const std::filesystem::path& folder, const Manifest& manifest,
                   Collected& collected) {
    if (manifest.command == "run") return;
    const std::vector<Value> parts = parts_of(folder, manifest);
    if (!parts.empty()) collected.files.push_back(write_joined(folder, parts));
}

}  // namespace weft::batch
