#include "apps/weft/batch/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "apps/weft/batch/axis.h"
#include "apps/weft/batch/sweep_tables.h"
#include "runtime/error.h"

namespace weft::batch {

namespace {

std::string read_text(const std::string& path) {
    if (std::filesystem::is_directory(path)) {
        throw UserError(path + ": is a folder, expected a sweep file (.toml)");
    }
    std::ifstream file(path, std::ios::binary);
    if (!file) throw UserError(path + ": no such sweep file");
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// A folder below out/ is called so.
std::string read_name(const Node& sweep) {
    const Node& node = required(sweep, "name");
    const std::string name = text_of(node, "name");
    const bool fits =
        !name.empty() && name.front() != '.' && std::ranges::all_of(name, [](unsigned char c) {
            return c >= 0x20 && c != 0x7f && c != '/' && c != '\\';
        });
    if (!fits) fail(node, "name", "expected a name that a folder can have");
    return name;
}

std::string read_command(const Node& sweep) {
    const Node* node = sweep.find("command");
    if (node == nullptr) return "run";
    const std::string name = text_of(*node, "command");
    if (std::ranges::find(sweep_commands(), name) == sweep_commands().end()) {
        fail(*node, "command",
             fmt::format("expected one of {}", fmt::join(sweep_commands(), ", ")));
    }
    return name;
}

void read_run_table(const Node& root, Sweep& sweep) {
    const Node* run = root.find("run");
    if (run == nullptr) return;
    if (!run->is_table())
        fail(*run, "run", "expected options of weft run, as in { device = \"cpu\" }");
    for (const Member& member : run->table()) {
        const Value value = to_json(member.value);
        if (member.key == "time_limit")
            sweep.time_limit = parse_duration(value, member.mark.text() + ": run.time_limit");
        else
            sweep.settings.push_back({"run." + member.key, value, member.mark});
    }
}

std::vector<Setting> read_conditions(const Node& table) {
    if (!table.is_table() || table.table().empty()) {
        fail(table, "leave_out", "expected values, as in \"solver.method\" = \"sosd\"");
    }
    std::vector<Setting> conditions;
    for (const Member& member : table.table()) {
        conditions.push_back({member.key, to_json(member.value), member.mark});
    }
    return conditions;
}

/// TOML takes scene.frames = 1 for a table `scene`.
void check_condition(const Setting& condition, const std::vector<std::string>& keys) {
    if (condition.value.is_object() && std::ranges::find(keys, condition.key) == keys.end()) {
        throw UserError(
            fmt::format("{}: {}: keys with dots stand in quotes here, as in \"scene.frames\" = 1",
                        condition.mark.text(), condition.key));
    }
    check_known(condition.mark, condition.key, keys);
}

/// A condition on a key that no axis has would never hold, or always.
void check_conditions(const Sweep& sweep) {
    std::vector<std::string> keys;
    for (const Axis& axis : sweep.axes) keys.insert(keys.end(), axis.keys.begin(), axis.keys.end());
    for (const auto& conditions : sweep.leave_out) {
        for (const Setting& condition : conditions) check_condition(condition, keys);
    }
}

void check_keys_differ(const Sweep& sweep) {
    std::set<std::string> seen;
    const auto add = [&](const std::string& key, const Mark& mark) {
        if (seen.insert(key).second) return;
        throw UserError(fmt::format("{}: {}: this key has its values already", mark.text(), key));
    };
    for (const Setting& setting : sweep.settings) add(setting.key, setting.mark);
    for (const Axis& axis : sweep.axes) {
        for (const Setting& setting : axis.steps.front()) add(setting.key, setting.mark);
    }
}

bool same_value(const Value& a, const Value& b) {
    if (a.is_number() && b.is_number()) return a.get<double>() == b.get<double>();
    return a == b;
}

bool is_left_out(const Point& point, const std::vector<Setting>& conditions) {
    return std::ranges::all_of(conditions, [&](const Setting& condition) {
        return std::ranges::any_of(point, [&](const Setting& setting) {
            return setting.key == condition.key && same_value(setting.value, condition.value);
        });
    });
}

std::string conditions_text(const std::vector<Setting>& conditions) {
    std::string text;
    for (const Setting& condition : conditions) {
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", condition.key,
                            to_toml(condition.value));
    }
    return text;
}

/// Whoever writes one means to leave something out.
void check_leave_out(const Sweep& sweep, const std::vector<Point>& points) {
    for (const auto& conditions : sweep.leave_out) {
        const bool matches = std::ranges::any_of(
            points, [&](const Point& point) { return is_left_out(point, conditions); });
        if (matches) continue;
        throw UserError(fmt::format("{}: [[leave_out]] {}: no run of the sweep has this",
                                    conditions.front().mark.text(), conditions_text(conditions)));
    }
}

void read_lists(const Node& root, Sweep& sweep) {
    for (const Node& table : tables(root, "axis"))
        sweep.axes.push_back(read_axis(table, sweep.path));
    for (const Node& table : tables(root, "leave_out")) {
        sweep.leave_out.push_back(read_conditions(table));
    }
}

}  // namespace

const std::vector<std::string>& sweep_commands() {
    static const std::vector<std::string> commands{"run", "error", "stability"};
    return commands;
}

Sweep parse_sweep(const std::string& text, const std::string& path) {
    const Node root = parse_toml(text, path);
    check_members(root, {"sweep", "run", "axis", "leave_out"});
    const Node& table = required(root, "sweep");
    if (!table.is_table()) fail(table, "sweep", "expected { name = \"...\", scene = \"...\" }");
    check_members(table, {"name", "scene", "command"});
    Sweep sweep;
    sweep.path = path;
    sweep.text = text;
    sweep.name = read_name(table);
    sweep.command = read_command(table);
    if (const Node* scene = table.find("scene")) {
        sweep.scene = text_of(*scene, "scene");
        sweep.scene_mark = scene->mark;
    }
    read_run_table(root, sweep);
    read_lists(root, sweep);
    check_keys_differ(sweep);
    check_conditions(sweep);
    return sweep;
}

Sweep read_sweep(const std::string& path) { return parse_sweep(read_text(path), path); }

std::string sweep_name(const std::string& path) {
    const Node root = parse_toml(read_text(path), path);
    const Node& table = required(root, "sweep");
    if (!table.is_table()) fail(table, "sweep", "expected { name = \"...\", scene = \"...\" }");
    return read_name(table);
}

std::vector<Point> points_of(const Sweep& sweep) {
    std::vector<Point> points{sweep.settings};
    for (const Axis& axis : sweep.axes) {
        std::vector<Point> longer;
        longer.reserve(points.size() * axis.steps.size());
        if (points.size() * axis.steps.size() > kMostRuns) {
            throw UserError(fmt::format("{}: more than {} runs", sweep.path, kMostRuns));
        }
        for (const Point& point : points) {
            for (const auto& step : axis.steps) {
                longer.push_back(point);
                longer.back().insert(longer.back().end(), step.begin(), step.end());
            }
        }
        points = std::move(longer);
    }
    check_leave_out(sweep, points);
    std::erase_if(points, [&](const Point& point) {
        return std::ranges::any_of(sweep.leave_out,
                                   [&](const auto& list) { return is_left_out(point, list); });
    });
    if (points.empty()) throw UserError(sweep.path + ": [[leave_out]] leaves no run");
    return points;
}

double parse_duration(const Value& value, const std::string& place) {
    const auto refuse = [&] {
        throw UserError(fmt::format("{} = {}: expected a time, as in \"90s\", \"20m\" or \"1h30m\"",
                                    place, to_toml(value)));
    };
    if (value.is_number() && value.get<double>() > 0.0) return value.get<double>();
    const std::string text = value.is_string() ? value.get<std::string>() : "";
    double seconds = 0.0;
    const char* at = text.data();
    const char* end = at + text.size();
    while (at != end) {
        double number = 0.0;
        const auto [stop, error] = std::from_chars(at, end, number);
        const std::string_view units = "smh";
        const std::size_t unit = stop == end ? units.npos : units.find(*stop);
        if (error != std::errc{} || unit == units.npos || number < 0.0) refuse();
        seconds += number * (unit == 0 ? 1.0 : unit == 1 ? 60.0 : 3600.0);
        at = stop + 1;
    }
    if (!(seconds > 0.0)) refuse();
    return seconds;
}

}  // namespace weft::batch
