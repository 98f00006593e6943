#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/weft/studies/stability/outcome.h"

namespace weft::stability {

std::string to_csv(const std::vector<Row>& rows);
nlohmann::ordered_json to_json(const std::vector<Row>& rows);
/// How many of what, per group and solver; and everything that was wrong without a word.
std::string to_text(const std::vector<Row>& rows);

}  // namespace weft::stability
