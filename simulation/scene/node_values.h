#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/error.h"
#include "simulation/mesh/vec3.h"
#include "simulation/scene/document.h"
#include "simulation/scene/keys.h"
#include "simulation/scene/scene.h"

/// Values out of a checked table (validate.h): types, lengths and ranges are known to be right, and
/// keys that are required or have a default are known to be there.
namespace weft {

double number_value(const Node& table, std::string_view key);
/// A number that does nothing at 0 counts as not named.
std::optional<double> optional_number(const Node& table, std::string_view key);
bool truth_value(const Node& table, std::string_view key);
int integer_value(const Node& table, std::string_view key);
std::string text_value(const Node& table, std::string_view key);
std::vector<double> numbers_of(const Node& list);
std::vector<double> number_values(const Node& table, std::string_view key);  ///< empty if absent
std::vector<int> integer_values(const Node& table, std::string_view key);
std::vector<std::string> text_values(const Node& table, std::string_view key);
Vec3 vec3_of(const Node& list);
Vec3 vec3_value(const Node& table, std::string_view key);
/// A vector that must not be zero.
Vec3 direction_value(const Node& table, std::string_view key);

/// `rotate = [ax, ay, az, degrees]` or a list of these; empty if absent.
Key rotation_key();
std::vector<Rotation> rotation_values(const Node& table, std::string_view key);

/// An error about the value of `key`: "file:line:column: key = value: what".
UserError value_error(const Node& table, std::string_view key, const std::string& what);

}  // namespace weft
