#pragma once

#include <string>

namespace weft {

/// JSON as text. Paths and names of devices are whatever bytes they are: those that are no UTF-8
/// become U+FFFD, where the library by itself would throw. indent: -1 puts it into one line.
template <class Json>
std::string json_text(const Json& json, int indent = 2) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace weft
