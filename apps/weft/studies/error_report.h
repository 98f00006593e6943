#pragma once

#include <nlohmann/json.hpp>

#include "apps/weft/studies/error_study.h"

namespace weft {

/// error.csv: one line per point.
std::string to_csv(const ErrorStudy& study);
/// Times and iterations to 1e-1, 1e-2 and 1e-3, for people.
std::string to_text(const ErrorStudy& study);
nlohmann::ordered_json to_json(const ErrorStudy& study);

}  // namespace weft
