#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/weft/batch/toml_values.h"

namespace weft::batch {

/// A value of a sweep, and where it was written.
struct Setting {
    std::string key;  ///< as --set takes it, or run.*, or sweep.scene
    Value value;
    Mark mark;
};

/// Keys that change together: each step gives all of them a value.
struct Axis {
    std::vector<std::string> keys;
    std::vector<std::vector<Setting>> steps;
};

/// A sweep file (docs/batch.md).
struct Sweep {
    std::string path;
    std::string text;
    std::string name;
    std::string command = "run";  ///< the subcommand that a run of the sweep is
    std::string scene;            ///< as written: relative to the sweep file
    Mark scene_mark;
    std::vector<Setting> settings;     ///< run.*, the same for all
    std::optional<double> time_limit;  ///< [s] that a process of --index may take
    std::vector<Axis> axes;
    std::vector<std::vector<Setting>> leave_out;  ///< points that have all of one list
};

/// One run: a value for every setting and axis, in the file's order.
using Point = std::vector<Setting>;

/// Reads and checks a sweep file, but for what its values mean. Throws UserError with file, line
/// and column.
Sweep read_sweep(const std::string& path);
/// The same for a text; `path` stands in messages, and its folder is where tables are looked for.
Sweep parse_sweep(const std::string& text, const std::string& path);

/// Only its name, which the sweep's folder is called by; the rest may be wrong.
std::string sweep_name(const std::string& path);

/// The product of the axes, the last one fastest, without what is left out. Throws UserError where
/// nothing remains, and where a list of what is left out matches nothing.
std::vector<Point> points_of(const Sweep& sweep);

/// "20m", "1h30m", "90s", or a number of seconds [s]. Throws UserError.
double parse_duration(const Value& value, const std::string& place);

}  // namespace weft::batch
