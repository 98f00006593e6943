#include "apps/weft/batch/runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "apps/weft/batch/sweep_tables.h"
#include "runtime/error.h"
#include "runtime/io/word_hash.h"
#include "simulation/bodies/mesh_files.h"
#include "simulation/scene/read_scene.h"

namespace weft::batch {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kIdDigits = 12;
constexpr const char* kRepeat = "run.repeat";

std::string hash_of(const std::string& text) {
    WordHash hash;
    for (const char c : text) hash.add(static_cast<unsigned char>(c));
    return hash.text();
}

bool is_option(const std::string& key) { return key.starts_with("run."); }
bool is_scene_value(const Setting& s) { return !is_option(s.key) && s.key != "sweep.scene"; }

/// "run.max-work" is max_work.
std::string option_key(const Setting& setting) {
    std::string key = setting.key.substr(std::string("run.").size());
    std::ranges::replace(key, '-', '_');
    return key;
}

/// Keys of `run` that a scene has, or that the sweep itself looks after, and what to do instead.
const std::map<std::string, std::string>& elsewhere() {
    static const std::map<std::string, std::string> keys{
        {"solver", "it is a value of the scene: use an axis on solver.method"},
        {"frames", "it is a value of the scene: use an axis on scene.frames"},
        {"substeps", "it is a value of the scene: use an axis on scene.substeps"},
        {"iterations", "it is a value of the scene: use an axis on solver.iterations"},
        {"set", "use an axis on the key itself, as on scene.frames"},
        {"time_limit", "it is the same for all runs: write it into the table 'run'"},
        {"out", "the sweep chooses its folders"},
        {"force", "'weft batch --index' has --again"},
        {"resume", "'weft batch --index' always does"},
        {"quiet", "it belongs to 'weft batch'"},
        {"json", "it belongs to 'weft batch'"},
        {"as_sweep", "this is one already"}};
    return keys;
}

/// Also of what is false, of which the command line shows nothing.
void check_option(const Setting& setting, const std::map<std::string, bool>& flags) {
    const auto refused = elsewhere().find(option_key(setting));
    if (refused != elsewhere().end()) {
        throw UserError(
            fmt::format("{}: {}: {}", setting.mark.text(), setting.key, refused->second));
    }
    if (setting.key == kRepeat) return;
    const auto known = flags.find(option_key(setting));
    if (known == flags.end()) {
        std::vector<std::string> keys{kRepeat, "run.time_limit"};
        for (const auto& [key, is_flag] : flags) {
            if (!elsewhere().contains(key)) keys.push_back("run." + key);
        }
        check_known(setting.mark, setting.key, keys);
    } else if (known->second != setting.value.is_boolean()) {
        throw UserError(fmt::format("{}: {} = {}: expected {}", setting.mark.text(), setting.key,
                                    to_toml(setting.value),
                                    known->second ? "true or false" : "a value"));
    }
}

std::string option_value(const Value& value) {
    if (!value.is_array()) return to_text(value);
    std::string list;
    for (const Value& item : value) list += (list.empty() ? "" : ",") + to_text(item);
    return list;
}

/// "run.max_work" is --max-work.
std::string option_name(const Setting& setting) {
    std::string name = option_key(setting);
    std::ranges::replace(name, '_', '-');
    return "--" + name;
}

/// run.device = "cpu" becomes --device cpu; true a flag; geometry = false becomes --no-geometry.
void append_option(std::vector<std::string>& arguments, const Setting& setting) {
    if (setting.key == kRepeat) return;
    const std::string name = option_name(setting);
    if (!setting.value.is_boolean()) {
        arguments.push_back(name);
        arguments.push_back(option_value(setting.value));
        return;
    }
    const bool on = setting.value.get<bool>();
    const bool written_unless_told = name == "--geometry" || name == "--trace";
    if (on && !written_unless_told) arguments.push_back(name);
    if (!on && written_unless_told) arguments.push_back("--no-" + name.substr(2));
}

std::string describe(const Point& point, std::size_t first) {
    std::string text;
    for (std::size_t i = first; i < point.size(); ++i) {
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", point[i].key,
                            to_toml(point[i].value));
    }
    return text;
}

class RunMaker {
public:
    RunMaker(const Sweep& sweep, const fs::path& folder, const CommandLine& command_line)
        : sweep_(sweep),
          folder_(fs::absolute(folder).lexically_normal()),
          command_line_(command_line) {}

    Run make(const Point& point) {
        Run run;
        std::vector<std::string> options;
        for (const Setting& setting : point) {
            if (!is_option(setting.key)) continue;
            check_option(setting, command_line_.flags);
            append_option(options, setting);
        }
        check_options(options, point);
        run.arguments = options;
        if (const fs::path scene = scene_of(point); !scene.empty()) {
            run.scene = fs::absolute(scene).lexically_normal().lexically_relative(folder_).string();
            run.scene_hash = hashes_.of(read_point(scene.string(), point, run.arguments));
        }
        for (std::size_t i = sweep_.settings.size(); i < point.size(); ++i) {
            run.values.emplace_back(point[i].key, point[i].value);
        }
        run.id = id_of(point, run.scene_hash);
        return run;
    }

private:
    fs::path scene_of(const Point& point) const {
        fs::path scene = sweep_.scene;
        Mark mark = sweep_.scene_mark;
        for (const Setting& setting : point) {
            if (setting.key != "sweep.scene") continue;
            if (!setting.value.is_string()) {
                throw UserError(setting.mark.text() + ": sweep.scene: expected a file");
            }
            scene = setting.value.get<std::string>();
            mark = setting.mark;
        }
        if (scene.empty() && sweep_.command == "stability") {
            check_no_scene_values(point);
            return {};
        }
        if (scene.empty()) {
            throw UserError(sweep_.path +
                            ": which scene? sweep = { scene = \"...\" }, or an axis sweep.scene");
        }
        fs::path file = (fs::path(sweep_.path).parent_path() / scene).lexically_normal();
        if (!fs::exists(file)) {
            throw UserError(fmt::format("{}: {}: no such scene file", mark.text(), file.string()));
        }
        return file;
    }

    static void check_no_scene_values(const Point& point) {
        for (const Setting& setting : point) {
            if (is_scene_value(setting))
                throw UserError(setting.mark.text() + ": " + setting.key + ": of which scene?");
        }
    }

    /// Options do not depend on the scene, and few differ.
    void check_options(const std::vector<std::string>& options, const Point& point) {
        if (!checked_.insert(options).second) return;
        try {
            command_line_.check(options);
        } catch (const UserError& error) {
            throw UserError(fmt::format("{}: run ({}): {}", place_of(error.what(), point),
                                        describe(point, 0), error.what()));
        }
    }

    /// Of the option that is refused alone, too; else of the sweep, as options that do not go
    /// together are no mistake of one of them.
    std::string place_of(const std::string& message, const Point& point) const {
        for (const Setting& setting : point) {
            if (is_option(setting.key) && is_refused_alone(setting, message))
                return setting.mark.text();
        }
        return sweep_.path;
    }

    bool is_refused_alone(const Setting& setting, const std::string& message) const {
        std::vector<std::string> words;
        append_option(words, setting);
        try {
            command_line_.check(words);
        } catch (const UserError& error) {
            return error.what() == message;
        }
        return false;
    }

    /// With the place of the value in front of what is wrong with it.
    Scene read_point(const std::string& scene, const Point& point,
                     std::vector<std::string>& arguments) const {
        std::vector<Override> overrides;
        for (const Setting& setting : point) {
            if (!is_scene_value(setting)) continue;
            const std::string assignment = setting.key + "=" + to_toml(setting.value);
            overrides.push_back({assignment, setting.mark.text()});
            arguments.push_back("--set");
            arguments.push_back(assignment);
        }
        return read_scene(scene, overrides);
    }

    /// The order of axes does not count, nor where the scene lies.
    std::string id_of(const Point& point, const std::string& scene_hash) const {
        std::vector<std::string> lines;
        for (const Setting& setting : point) {
            if (setting.key != "sweep.scene") {
                lines.push_back(setting.key + " = " + to_toml(setting.value));
            }
        }
        std::ranges::sort(lines);
        std::string text = sweep_.command + '\n' + scene_hash;
        for (const std::string& line : lines) text += '\n' + line;
        return hash_of(text).substr(0, kIdDigits);
    }

    const Sweep& sweep_;
    fs::path folder_;
    const CommandLine& command_line_;
    SceneHashes hashes_;
    std::set<std::vector<std::string>> checked_;
};

}  // namespace

std::string SceneHashes::of(const Scene& scene) {
    std::string text = scene.text;
    for (const BodyMesh& mesh : mesh_files(scene)) {
        auto known =
            std::ranges::find(meshes_, mesh.named, &std::pair<std::string, std::string>::first);
        if (known == meshes_.end()) {
            known = meshes_.insert(meshes_.end(), {mesh.named, mesh_hash(mesh)});
        }
        text += '\n' + known->second;
    }
    return hash_of(text);
}

std::vector<Run> runs_of(const Sweep& sweep, const fs::path& folder,
                         const CommandLine& command_line) {
    RunMaker maker(sweep, folder, command_line);
    std::vector<Run> runs;
    std::map<std::string, std::size_t> seen;
    for (const Point& point : points_of(sweep)) {
        Run run = maker.make(point);
        run.index = runs.size();
        const auto [same, is_new] = seen.emplace(run.id, run.index);
        if (!is_new) {
            throw UserError(fmt::format(
                "{}: runs {} and {} are the same ({}); an axis run.repeat tells repeats apart",
                sweep.path, same->second, run.index, describe(point, sweep.settings.size())));
        }
        runs.push_back(std::move(run));
    }
    return runs;
}

}  // namespace weft::batch
