#include "simulation/run/troubles.h"

#include <fmt/format.h>

#include <utility>

#include "simulation/checks/watch.h"

namespace weft {

void Troubles::tell_once(int frame, std::string what) {
    list_.push_back({frame, std::move(what), false});
}

void Troubles::tell(int frame, const Alarm& alarm, const std::string& what) {
    constexpr std::size_t kMost = 10;
    if (list_.size() >= kMost) return;
    std::string text = fmt::format("{}; {}", alarm.what, what);
    if (list_.size() + 1 == kMost) text += "; what comes after this is not told";
    list_.push_back({frame, std::move(text), alarm.kind != Alarm::Kind::kDoubt});
}

}  // namespace weft
