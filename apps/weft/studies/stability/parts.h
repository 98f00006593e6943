#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "apps/weft/studies/stability/outcome.h"
#include "apps/weft/studies/stability/recommend.h"

/// The suite, or the settings for a scene, shared by several runs of a sweep: what each finds as
/// JSON, and all of it together again.
namespace weft::stability {

inline constexpr const char* kSuite = "stability";
inline constexpr const char* kSettings = "settings";

nlohmann::ordered_json to_part(const std::vector<Row>& rows);
nlohmann::ordered_json to_part(const Advice& advice);

/// In the suite's order, and by solver. Throws UserError for cases that this version does not have.
std::vector<Row> join_suite_parts(const std::vector<nlohmann::ordered_json>& parts);

/// Chosen anew among all trials. At least one part.
Advice join_settings_parts(const std::vector<nlohmann::ordered_json>& parts);

}  // namespace weft::stability
