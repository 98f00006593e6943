#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace weft {

/// The solvers by the names that scenes give them.
enum class Method { kXpbd, kVbd, kSosd, kJpgd, kNewton };

std::vector<std::string> method_names();
std::string_view name_of(Method method);
/// name: one of method_names()
Method method_named(std::string_view name);

/// Whether it computes vertex by vertex: then vertices of different seams must not be neighbours.
bool is_vertex_wise(Method method);

}  // namespace weft
