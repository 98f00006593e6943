#include "apps/weft/plan/json_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <regex>

#include "runtime/error.h"
#include "runtime/io/json_text.h"
#include "runtime/near_miss.h"

namespace weft {

namespace {

/// "[json.exception.parse_error.101] parse error at line 3, column 7: syntax error while parsing
/// value - unexpected ..."
[[noreturn]] void fail_syntax(const std::string& path, const std::string& message) {
    static const std::regex pattern(
        R"(^\[[^\]]*\] (?:parse error at line (\d+), column (\d+): )?)");
    std::smatch match;
    if (!std::regex_search(message, match, pattern)) throw UserError(path + ": " + message);
    const std::string place =
        match[1].matched ? fmt::format(":{}:{}", match[1].str(), match[2].str()) : "";
    throw UserError(fmt::format("{}{}: not JSON: {}", path, place, match.suffix().str()));
}

}  // namespace

JsonFile::JsonFile(std::string path) : path_(std::move(path)) {
    errno = 0;
    std::ifstream stream(path_, std::ios::binary);
    if (!stream) fail(std::strerror(errno));
    if (std::filesystem::is_directory(path_)) fail("is a folder, not a file");
    try {
        root_ = Json::parse(stream);
    } catch (const Json::exception& error) {
        fail_syntax(path_, error.what());
    }
}

void JsonFile::fail(const std::string& what) const {
    throw UserError(fmt::format("{}: {}", path_, what));
}

void JsonFile::fail(const std::string& field, const std::string& what) const {
    fail(fmt::format("{}: {}", field, what));
}

void JsonFile::check_keys(const Json& object, const std::vector<std::string>& known,
                          const std::string& prefix) const {
    for (const auto& [key, value] : object.items()) {
        if (std::find(known.begin(), known.end(), key) != known.end()) continue;
        const std::string near = near_miss(key, known);
        if (!near.empty()) fail(prefix + key, "unknown key; " + near);
    }
}

const JsonFile::Json& JsonFile::member(const Json& object, const std::string& key,
                                       const std::string& prefix) const {
    if (!object.contains(key)) fail(prefix + key, "is missing");
    return object[key];
}

std::string JsonFile::shown(const Json& value) {
    const std::string text = json_text(value, -1);
    return text.size() <= 40 ? text : text.substr(0, 37) + "...";
}

double JsonFile::number(const Json& value, const std::string& field,
                        const std::string& expected) const {
    constexpr double kMost = 1e100;  // sums and products of such are finite
    const double number = value.is_number() ? value.get<double>() : -1.0;
    if (number > kMost) fail(field, fmt::format("must be at most {}, not {}", kMost, shown(value)));
    if (std::isfinite(number) && number >= 0.0) return number;
    fail(field, fmt::format("expected {}, not {}", expected, shown(value)));
}

std::string JsonFile::name(const Json& value, const std::string& field) const {
    if (!value.is_string() || value.get<std::string>().empty()) {
        fail(field, fmt::format("expected a name in quotes, not {}", shown(value)));
    }
    return value.get<std::string>();
}

const JsonFile::Json& JsonFile::array(const Json& value, const std::string& field,
                                      const std::string& expected) const {
    if (!value.is_array()) fail(field, fmt::format("expected {}, not {}", expected, shown(value)));
    return value;
}

const JsonFile::Json& JsonFile::object(const Json& value, const std::string& field,
                                       const std::string& expected) const {
    if (!value.is_object()) {
        fail(field, fmt::format("expected {}, not {}", expected, shown(value)));
    }
    return value;
}

std::vector<std::string> JsonFile::names(const Json& value, const std::string& field,
                                         const std::string& what) const {
    std::vector<std::string> list;
    array(value, field, "a list of names");
    for (std::size_t i = 0; i < value.size(); ++i) {
        const std::string own_field = fmt::format("{}[{}]", field, i);
        std::string own = name(value[i], own_field);
        if (std::find(list.begin(), list.end(), own) != list.end()) {
            fail(own_field, fmt::format("duplicate {} '{}'", what, own));
        }
        list.push_back(std::move(own));
    }
    if (list.empty()) fail(field, "at least one is needed");
    return list;
}

namespace {

/// Reads one of the two members.
class LinkReader {
public:
    LinkReader(const JsonFile& file, std::size_t count, const std::string& key)
        : file_(file),
          count_(count),
          key_(key),
          expected_(fmt::format("a number or {0} rows of {0} numbers >= 0", count)) {}

    template <class Read>
    std::vector<double> read(double usual, Read read_value) const {
        std::vector<double> values(count_ * count_, usual);
        if (!file_.root().contains(key_)) return values;
        const JsonFile::Json& value = file_.root()[key_];
        if (!value.is_array()) {
            std::fill(values.begin(), values.end(), read_value(value, key_));
            return values;
        }
        check_size(value, key_);
        for (std::size_t from = 0; from < count_; ++from) {
            const std::string row = fmt::format("{}[{}]", key_, from);
            check_size(value[from], row);
            for (std::size_t to = 0; to < count_; ++to) {
                if (from == to) continue;
                values[from * count_ + to] =
                    read_value(value[from][to], fmt::format("{}[{}]", row, to));
            }
        }
        return values;
    }

private:
    void check_size(const JsonFile::Json& list, const std::string& field) const {
        file_.array(list, field, expected_);
        if (list.size() == count_) return;
        file_.fail(field, fmt::format("expected {}, not a list of {}", expected_, list.size()));
    }

    const JsonFile& file_;
    std::size_t count_;
    std::string key_;
    std::string expected_;
};

}  // namespace

LinkValues read_links(const JsonFile& file, std::size_t count, double usual_bandwidth) {
    const auto time = [&](const JsonFile::Json& value, const std::string& field) {
        return file.number(value, field, "a number >= 0");
    };
    const auto positive = [&](const JsonFile::Json& value, const std::string& field) {
        if (value.is_null()) return std::numeric_limits<double>::infinity();
        const double number = file.number(value, field, "a number > 0");
        if (number == 0.0) file.fail(field, "expected a number > 0, not 0");
        return number;
    };
    return {LinkReader(file, count, "latency").read(0.0, time),
            LinkReader(file, count, "bandwidth").read(usual_bandwidth, positive)};
}

}  // namespace weft
