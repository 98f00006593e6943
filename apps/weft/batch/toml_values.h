#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "simulation/scene/document.h"

namespace weft::batch {

using Value = nlohmann::ordered_json;

/// A value of a TOML file as JSON, for the manifest. Throws UserError, with the place, for what
/// JSON cannot hold: dates, infinities.
Value to_json(const Node& node);

/// The same value on one line of TOML, as `--set` takes it.
std::string to_toml(const Value& value);

/// As a person would write it in a table: texts without quotes.
std::string to_text(const Value& value);

}  // namespace weft::batch
