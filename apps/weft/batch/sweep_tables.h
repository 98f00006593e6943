#pragma once

#include <string>
#include <vector>

#include "simulation/scene/document.h"

/// What reading a sweep file needs of its tables. All throw UserError with file, line and column.
namespace weft::batch {

/// Subcommands that a sweep can be made of.
const std::vector<std::string>& sweep_commands();

/// Far more than any sweep: whoever asks for so many has made a slip.
constexpr std::size_t kMostRuns = 1'000'000;

[[noreturn]] void fail(const Node& node, const std::string& key, const std::string& what);

/// `key` is one of these; otherwise the nearest is suggested.
void check_known(const Mark& mark, const std::string& key, const std::vector<std::string>& known);
void check_members(const Node& table, const std::vector<std::string>& known);
const Node& required(const Node& table, const std::string& key);
/// A text that is not empty.
std::string text_of(const Node& node, const std::string& key);
/// The entries of [[key]]; none where it is left out.
std::vector<Node> tables(const Node& root, const std::string& key);

}  // namespace weft::batch
