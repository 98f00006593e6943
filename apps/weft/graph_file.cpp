#include "apps/weft/graph_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <unordered_map>

#include "runtime/error.h"
#include "simulation/scene/near_miss.h"

namespace weft {
namespace {

using nlohmann::json;
using scheduler::ProcessorId;
using scheduler::TaskId;

/// Reads one file; every complaint names it.
class GraphReader {
public:
    explicit GraphReader(std::string path) : path_(std::move(path)) {}

    GraphFile read() {
        const json root = parse();
        if (!root.is_object()) fail("expected one object {...} with processors, tasks and edges");
        check_keys(root, {"processors", "tasks", "edges", "latency", "bandwidth"}, "");
        read_processors(member(root, "processors", ""));
        file_.graph.clear(processor_count());
        read_links(root);
        read_tasks(member(root, "tasks", ""));
        if (root.contains("edges")) read_edges(root["edges"]);
        try {
            file_.graph.seal();
        } catch (const scheduler::GraphError& error) {
            fail("edges", error.what());
        }
        return std::move(file_);
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw UserError(fmt::format("{}: {}", path_, what));
    }
    [[noreturn]] void fail(const std::string& field, const std::string& what) const {
        fail(fmt::format("{}: {}", field, what));
    }

    ProcessorId processor_count() const {
        return static_cast<ProcessorId>(file_.processors.size());
    }

    json parse() const {
        std::ifstream stream(path_, std::ios::binary);
        if (!stream) fail(std::strerror(errno));
        if (std::filesystem::is_directory(path_)) fail("is a folder, not a file");
        try {
            return json::parse(stream);
        } catch (const json::exception& error) {
            fail_syntax(error.what());
        }
    }

    // "[json.exception.parse_error.101] parse error at line 3, column 7: syntax error while parsing
    // value - unexpected ..."
    [[noreturn]] void fail_syntax(const std::string& message) const {
        static const std::regex pattern(
            R"(^\[[^\]]*\] (?:parse error at line (\d+), column (\d+): )?)");
        std::smatch match;
        if (!std::regex_search(message, match, pattern)) fail(message);
        const std::string place =
            match[1].matched ? fmt::format(":{}:{}", match[1].str(), match[2].str()) : "";
        throw UserError(fmt::format("{}{}: not JSON: {}", path_, place, match.suffix().str()));
    }

    // Other keys are left to whoever wrote them; but not those that look like a slip of ours.
    void check_keys(const json& object, const std::vector<std::string>& known,
                    const std::string& prefix) const {
        for (const auto& [key, value] : object.items()) {
            if (std::find(known.begin(), known.end(), key) != known.end()) continue;
            const std::string near = near_miss(key, known);
            if (!near.empty()) fail(prefix + key, "unknown key; " + near);
        }
    }

    const json& member(const json& object, const std::string& key,
                       const std::string& prefix) const {
        if (!object.contains(key)) fail(prefix + key, "is missing");
        return object[key];
    }

    static std::string shown(const json& value) {
        const std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
        return text.size() <= 40 ? text : text.substr(0, 37) + "...";
    }

    double number(const json& value, const std::string& field, const std::string& expected) const {
        if (!value.is_number())
            fail(field, fmt::format("expected {}, not {}", expected, shown(value)));
        const double number = value.get<double>();
        if (!std::isfinite(number) || number < 0.0) {
            fail(field, fmt::format("expected {}, not {}", expected, shown(value)));
        }
        return number;
    }

    std::string name(const json& value, const std::string& field) const {
        if (!value.is_string() || value.get<std::string>().empty()) {
            fail(field, fmt::format("expected a name in quotes, not {}", shown(value)));
        }
        return value.get<std::string>();
    }

    const json& array(const json& value, const std::string& field,
                      const std::string& expected) const {
        if (!value.is_array())
            fail(field, fmt::format("expected {}, not {}", expected, shown(value)));
        return value;
    }

    void read_processors(const json& list) {
        array(list, "processors", "a list of names");
        for (std::size_t i = 0; i < list.size(); ++i) {
            const std::string field = fmt::format("processors[{}]", i);
            std::string own = name(list[i], field);
            const auto& known = file_.processors;
            if (std::find(known.begin(), known.end(), own) != known.end()) {
                fail(field, fmt::format("duplicate processor '{}'", own));
            }
            file_.processors.push_back(std::move(own));
        }
        if (file_.processors.empty()) fail("processors", "at least one is needed");
    }

    /// One number for all links, or a matrix; its diagonal does not count.
    template <class Set>
    void read_link_values(const json& root, const std::string& key, const Set& set) const {
        if (!root.contains(key)) return;
        const json& value = root[key];
        const std::string expected =
            fmt::format("a number or {0} rows of {0} numbers >= 0", processor_count());
        for (ProcessorId from = 0; from < processor_count(); ++from) {
            for (ProcessorId to = 0; to < processor_count(); ++to) {
                if (from == to) continue;
                if (value.is_number()) {
                    set(from, to, number(value, key, "a number >= 0"), key);
                    continue;
                }
                const std::string field = fmt::format("{}[{}][{}]", key, from, to);
                check_size(value, key, expected);
                check_size(value[from], fmt::format("{}[{}]", key, from), expected);
                set(from, to, number(value[from][to], field, "a number >= 0"), field);
            }
        }
        if (processor_count() == 1 && value.is_number()) number(value, key, "a number >= 0");
    }

    void check_size(const json& list, const std::string& field, const std::string& expected) const {
        array(list, field, expected);
        if (list.size() != processor_count()) {
            fail(field, fmt::format("expected {}, not a list of {}", expected, list.size()));
        }
    }

    void read_links(const json& root) {
        const std::size_t count = file_.processors.size();
        std::vector<double> latency(count * count, 0.0), bandwidth(count * count, 1.0);
        read_link_values(root, "latency", [&](auto from, auto to, double value, const auto&) {
            latency[from * count + to] = value;
        });
        const auto positive = [&](auto from, auto to, double value, const std::string& field) {
            if (value == 0.0) fail(field, "expected a number > 0, not 0");
            bandwidth[from * count + to] = value;
        };
        read_link_values(root, "bandwidth", positive);
        if (count < 2) return;
        file_.graph.set_links(latency[1], bandwidth[1]);
        for (ProcessorId from = 0; from < count; ++from) {
            for (ProcessorId to = 0; to < count; ++to) {
                const std::size_t i = from * count + to;
                const bool alike = latency[i] == latency[1] && bandwidth[i] == bandwidth[1];
                if (from != to && !alike) file_.graph.set_link(from, to, latency[i], bandwidth[i]);
            }
        }
    }

    void read_tasks(const json& list) {
        array(list, "tasks", "a list of tasks");
        if (list.empty()) fail("tasks", "the graph is empty: at least one task is needed");
        for (std::size_t i = 0; i < list.size(); ++i)
            read_task(list[i], fmt::format("tasks[{}]", i));
    }

    void read_task(const json& task, const std::string& field) {
        if (!task.is_object()) {
            fail(field,
                 fmt::format("expected {{\"name\": ..., \"cost\": [...]}}, not {}", shown(task)));
        }
        check_keys(task, {"name", "cost"}, field + ".");
        const std::string own = name(member(task, "name", field + "."), field + ".name");
        if (ids_.contains(own)) {
            fail(field + ".name",
                 fmt::format("duplicate task '{}', the same as tasks[{}]", own, ids_.at(own)));
        }
        const std::string cost_field = field + ".cost";
        const json& list = array(member(task, "cost", field + "."), cost_field,
                                 "a list with one number or null per processor");
        if (list.size() != processor_count()) {
            fail(cost_field, fmt::format("task '{}' has {} costs for {} processors", own,
                                         list.size(), processor_count()));
        }
        std::vector<double> cost;
        for (std::size_t p = 0; p < list.size(); ++p) {
            cost.push_back(list[p].is_null()
                               ? scheduler::kCannotRun
                               : number(list[p], fmt::format("{}[{}]", cost_field, p),
                                        "a finite number >= 0, or null where it cannot run"));
        }
        if (std::ranges::all_of(cost, [](double c) { return c == scheduler::kCannotRun; })) {
            fail(cost_field, fmt::format("no processor can run task '{}'", own));
        }
        ids_[own] = file_.graph.add_task(cost, {.name = own});
        names_.push_back(own);
    }

    void read_edges(const json& list) {
        array(list, "edges", "a list of [from, to, data]");
        for (std::size_t i = 0; i < list.size(); ++i) {
            const std::string field = fmt::format("edges[{}]", i);
            const json& edge = list[i];
            if (!edge.is_array() || edge.size() != 3) {
                fail(field, fmt::format("expected [\"from\", \"to\", data], not {}", shown(edge)));
            }
            const TaskId from = task_named(edge[0], field + "[0]");
            const TaskId to = task_named(edge[1], field + "[1]");
            file_.graph.add_edge(from, to, number(edge[2], field + "[2]", "a finite number >= 0"));
        }
    }

    TaskId task_named(const json& value, const std::string& field) const {
        const std::string wanted = name(value, field);
        const auto found = ids_.find(wanted);
        if (found != ids_.end()) return found->second;
        const std::string near = near_miss(wanted, names_);
        fail(field, fmt::format("unknown task '{}'{}{}", wanted, near.empty() ? "" : "; ", near));
    }

    std::string path_;
    GraphFile file_;
    std::unordered_map<std::string, TaskId> ids_;
    std::vector<std::string> names_;
};

}  // namespace

GraphFile read_graph_file(const std::string& path) { return GraphReader(path).read(); }

}  // namespace weft
