#include "apps/weft/batch/manifest.h"

#include <fmt/format.h>

#include <fstream>
#include <map>

#include "runtime/error.h"
#include "runtime/io/json_text.h"
#include "runtime/io/whole_file.h"

namespace weft::batch {

namespace {

namespace fs = std::filesystem;

constexpr const char* kFormat = "weft-batch";
constexpr int kVersion = 1;

Value head_json(const Manifest& manifest) {
    Value head{{"format", kFormat},           {"format_version", kVersion},
               {"weft", manifest.weft},       {"name", manifest.name},
               {"command", manifest.command}, {"count", manifest.runs.size()}};
    if (manifest.time_limit) head["time_limit_s"] = *manifest.time_limit;
    head["file"] = manifest.file;
    head["sweep"] = manifest.sweep;
    return head;
}

Value run_json(const Run& run) {
    Value values = Value::object();
    for (const auto& [key, value] : run.values) values[key] = value;
    Value line{{"index", run.index},           {"id", run.id},     {"scene", run.scene},
               {"scene_hash", run.scene_hash}, {"values", values}, {"args", run.arguments}};
    if (run.dropped) line["dropped"] = true;
    return line;
}

void read_head(const Value& head, const std::string& path, Manifest& manifest) {
    if (head.at("format") != kFormat) throw UserError(path + ": it is no manifest of weft batch");
    const int version = head.at("format_version");
    if (version != kVersion) {
        throw UserError(fmt::format("{}: its format has version {}, this weft reads {}", path,
                                    version, kVersion));
    }
    manifest.name = head.at("name");
    manifest.command = head.at("command");
    manifest.weft = head.at("weft");
    manifest.file = head.value("file", "");
    manifest.sweep = head.at("sweep");
    if (head.contains("time_limit_s")) manifest.time_limit = head["time_limit_s"].get<double>();
}

Run read_run(const Value& line) {
    Run run;
    run.index = line.at("index");
    run.id = line.at("id");
    run.scene = line.at("scene");
    run.scene_hash = line.at("scene_hash");
    for (const auto& [key, value] : line.at("values").items()) run.values.emplace_back(key, value);
    run.arguments = line.at("args").get<std::vector<std::string>>();
    run.dropped = line.value("dropped", false);
    return run;
}

[[noreturn]] void refuse_damaged(const std::string& place, const std::string& what) {
    throw UserError(fmt::format(
        "{}: {}: the manifest is damaged; delete it, and make the sweep again ('weft batch "
        "SWEEP.toml'): what is done is kept, but runs may have other numbers",
        place, what));
}

/// What `read` makes of a line. Throws UserError with the line's place.
template <class Read>
void read_line(const std::string& line, const std::string& place, const Read& read) {
    try {
        read(Value::parse(line));
    } catch (const Value::exception&) {
        refuse_damaged(place, "this line cannot be read");
    }
}

Manifest parse(std::istream& file, const std::string& path) {
    Manifest manifest;
    std::string line;
    if (!std::getline(file, line)) refuse_damaged(path, "the file is empty");
    std::size_t count = 0;
    read_line(line, path + ":1", [&](const Value& head) {
        read_head(head, path, manifest);
        count = head.at("count");
    });
    while (std::getline(file, line)) {
        const std::size_t index = manifest.runs.size();
        const std::string place = fmt::format("{}:{}", path, index + 2);
        read_line(line, place, [&](const Value& run) { manifest.runs.push_back(read_run(run)); });
        if (manifest.runs.back().index == index) continue;
        refuse_damaged(place, fmt::format("run {} stands where run {} should",
                                          manifest.runs.back().index, index));
    }
    if (manifest.runs.size() != count) {
        refuse_damaged(path,
                       fmt::format("it has {} runs and says {}", manifest.runs.size(), count));
    }
    return manifest;
}

}  // namespace

std::vector<std::size_t> Manifest::current() const {
    std::vector<std::size_t> indices;
    for (const Run& run : runs) {
        if (!run.dropped) indices.push_back(run.index);
    }
    return indices;
}

std::string to_jsonl(const Manifest& manifest) {
    std::string text = json_text(head_json(manifest), -1) + '\n';
    for (const Run& run : manifest.runs) text += json_text(run_json(run), -1) + '\n';
    return text;
}

fs::path manifest_path(const fs::path& folder) { return folder / "manifest.jsonl"; }

Manifest read_manifest(const fs::path& folder) {
    const fs::path path = manifest_path(folder);
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw UserError(path.string() +
                        ": is not there; 'weft batch SWEEP.toml' checks a sweep and makes it");
    }
    return parse(file, path.string());
}

void check_made_by(const Manifest& manifest, const fs::path& folder,
                   const std::string& sweep_file) {
    if (manifest.file.empty()) return;
    const fs::path maker = (folder / manifest.file).lexically_normal();
    if (!fs::exists(maker) || !fs::exists(sweep_file) || fs::equivalent(maker, sweep_file)) return;
    throw UserError(fmt::format(
        "{}: {} is the folder of {}, which has the same name '{}'; give one of them another name, "
        "or this one another --out",
        sweep_file, folder.string(), maker.string(), manifest.name));
}

void write_manifest(const fs::path& folder, const Manifest& manifest) {
    write_whole_file(manifest_path(folder), to_jsonl(manifest));
}

std::vector<Run> merged(const std::vector<Run>& before, std::vector<Run> now) {
    std::map<std::string, std::size_t> known;
    std::vector<Run> runs = before;
    for (Run& run : runs) {
        known[run.id] = run.index;
        run.dropped = true;
    }
    for (Run& run : now) {
        const auto at = known.find(run.id);
        run.index = at == known.end() ? runs.size() : at->second;
        if (at == known.end())
            runs.push_back(std::move(run));
        else
            runs[run.index] = std::move(run);
    }
    return runs;
}

}  // namespace weft::batch
