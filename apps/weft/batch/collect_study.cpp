#include "apps/weft/batch/collect_study.h"

#include <fstream>

#include "apps/weft/batch/drive.h"
#include "apps/weft/studies/study_files.h"
#include "apps/weft/studies/study_parts.h"
#include "runtime/error.h"

namespace weft::batch {

namespace {

std::vector<Value> finished_parts(const std::filesystem::path& folder, const Manifest& manifest) {
    std::vector<Value> parts;
    for (const Listed& listed : list_runs(folder, manifest, false)) {
        if (listed.status.state != State::kFinished) continue;
        const auto path = run_path(folder, *listed.run) / "study.json";
        std::ifstream file(path);
        const Value part = Value::parse(file, nullptr, /*allow_exceptions=*/false);
        if (!part.is_object()) throw RunError(path.string() + ": cannot be read");
        parts.push_back(part);
    }
    return parts;
}

}  // namespace

void collect_study(const std::filesystem::path& folder, const Manifest& manifest,
                   Collected& collected) {
    if (manifest.command != "error") return;
    const std::vector<Value> parts = finished_parts(folder, manifest);
    if (parts.empty()) return;
    collected.files.push_back(is_trajectory_part(parts.front())
                                  ? write_study(folder, join_trajectory_parts(parts))
                                  : write_study(folder, join_error_parts(parts)));
}

}  // namespace weft::batch
