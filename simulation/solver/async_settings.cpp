#include "simulation/solver/async_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

#include "runtime/error.h"

namespace weft {

namespace {

using Merge = AsyncSettings::Merge;
using Tasks = AsyncSettings::Tasks;
using Order = AsyncSettings::Order;

template <class Value, std::size_t N>
using Names = std::array<std::pair<const char*, Value>, N>;

constexpr Names<Merge, 4> kMerges{{{"auto", Merge::kAuto},
                                   {"sum", Merge::kSum},
                                   {"mean", Merge::kMean},
                                   {"position", Merge::kPosition}}};
constexpr Names<Tasks, 2> kTasks{{{"strips", Tasks::kStrips}, {"kinds", Tasks::kKinds}}};
constexpr Names<Order, 4> kOrders{{{"both", Order::kBoth},
                                   {"free", Order::kFree},
                                   {"within", Order::kWithin},
                                   {"across", Order::kAcross}}};
constexpr Names<bool, 2> kSwitch{{{"on", true}, {"off", false}}};

[[noreturn]] void refuse(const std::string& key, const std::string& value,
                         const std::string& expected) {
    throw UserError(fmt::format("--async {}={}: expected {}", key, value, expected));
}

template <class Number>
Number number_in(const std::string& key, const std::string& value, Number least, Number most) {
    Number number{};
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    const bool is_whole = error == std::errc() && end == value.data() + value.size();
    if (!is_whole || !(number >= least && number <= most)) {
        refuse(key, value, fmt::format("a number from {} to {}", least, most));
    }
    return number;
}

template <class Value, std::size_t N>
Value value_of(const Names<Value, N>& names, const std::string& key, const std::string& text) {
    std::vector<std::string> known;
    for (const auto& [name, value] : names) {
        if (text == name) return value;
        known.emplace_back(name);
    }
    const std::string last = known.back();
    known.pop_back();
    refuse(key, text, fmt::format("{} or {}", fmt::join(known, ", "), last));
}

template <class Value, std::size_t N>
std::string name_of(const Names<Value, N>& names, Value value) {
    return std::ranges::find(names, value, &std::pair<const char*, Value>::second)->first;
}

void set(AsyncSettings& settings, const std::string& key, const std::string& value) {
    if (key == "window") {
        settings.window = number_in(key, value, 1, 64);
    } else if (key == "wait") {
        settings.wait = number_in(key, value, 0.0, 64.0);
    } else if (key == "merge") {
        settings.merge = value_of(kMerges, key, value);
    } else if (key == "dropping") {
        settings.dropping = value_of(kSwitch, key, value);
    } else if (key == "tasks") {
        settings.tasks = value_of(kTasks, key, value);
    } else if (key == "order") {
        settings.order = value_of(kOrders, key, value);
    } else if (key == "rank") {
        settings.rank = value_of(kSwitch, key, value);
    } else if (key == "settle") {
        settings.settle = number_in(key, value, 0, 64);
    } else {
        throw UserError(
            fmt::format("--async {}: there are window, wait, merge, dropping, settle, tasks, order "
                        "and rank, as "
                        "in window=3",
                        key));
    }
}

}  // namespace

AsyncSettings parse_async_settings(const std::string& text) {
    AsyncSettings settings;
    std::istringstream in(text);
    for (std::string item; std::getline(in, item, ',');) {
        const auto equals = item.find('=');
        set(settings, item.substr(0, equals),
            equals == std::string::npos ? "" : item.substr(equals + 1));
    }
    if (!settings.rank && settings.tasks == Tasks::kStrips) {
        throw UserError(
            "--async rank=off: only tasks=kinds has a rank; strips are done in the solver's order");
    }
    return settings;
}

std::string to_text(const AsyncSettings& settings) {
    std::string text = fmt::format("window={}", settings.window);
    if (settings.wait) text += fmt::format(",wait={}", *settings.wait);
    text += fmt::format(",merge={},dropping={}", name_of(kMerges, settings.merge),
                        name_of(kSwitch, settings.dropping));
    if (settings.tasks != Tasks::kStrips) {
        text += fmt::format(",tasks={},rank={}", name_of(kTasks, settings.tasks),
                            name_of(kSwitch, settings.rank));
    }
    if (settings.order != Order::kBoth) {
        text += fmt::format(",order={}", name_of(kOrders, settings.order));
    }
    if (settings.settle) text += fmt::format(",settle={}", *settings.settle);
    return text;
}

}  // namespace weft
