#include "simulation/solver/async_settings.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <sstream>
#include <utility>

#include "runtime/error.h"

namespace weft {

namespace {

using Merge = AsyncSettings::Merge;

constexpr std::array<std::pair<const char*, Merge>, 4> kMerges{{{"auto", Merge::kAuto},
                                                                {"sum", Merge::kSum},
                                                                {"mean", Merge::kMean},
                                                                {"position", Merge::kPosition}}};

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

Merge merge_of(const std::string& value) {
    for (const auto& [name, merge] : kMerges) {
        if (value == name) return merge;
    }
    refuse("merge", value, "auto, sum, mean or position");
}

void set(AsyncSettings& settings, const std::string& key, const std::string& value) {
    if (key == "window") {
        settings.window = number_in(key, value, 1, 64);
    } else if (key == "wait") {
        settings.wait = number_in(key, value, 0.0, 64.0);
    } else if (key == "merge") {
        settings.merge = merge_of(value);
    } else if (key == "dropping") {
        if (value != "on" && value != "off") refuse(key, value, "on or off");
        settings.dropping = value == "on";
    } else if (key == "settle") {
        settings.settle = number_in(key, value, 0, 64);
    } else {
        throw UserError(fmt::format(
            "--async {}: there are window, wait, merge, dropping and settle, as in window=3", key));
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
    return settings;
}

std::string to_text(const AsyncSettings& settings) {
    std::string text = fmt::format("window={}", settings.window);
    if (settings.wait) text += fmt::format(",wait={}", *settings.wait);
    for (const auto& [name, merge] : kMerges) {
        if (settings.merge == merge) text += fmt::format(",merge={}", name);
    }
    text += settings.dropping ? ",dropping=on" : ",dropping=off";
    if (settings.settle) text += fmt::format(",settle={}", *settings.settle);
    return text;
}

}  // namespace weft
