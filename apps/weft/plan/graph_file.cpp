#include "apps/weft/plan/graph_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <unordered_map>

#include "apps/weft/plan/json_file.h"
#include "runtime/near_miss.h"

namespace weft {
namespace {

using json = JsonFile::Json;
using scheduler::ProcessorId;
using scheduler::TaskId;

/// Reads one file; every complaint names it.
class GraphReader {
public:
    explicit GraphReader(const std::string& path) : json_(path) {}

    GraphFile read() {
        const json& root = json_.root();
        if (!root.is_object()) {
            json_.fail("expected one object {...} with processors, tasks and edges");
        }
        json_.check_keys(root, {"processors", "tasks", "edges", "latency", "bandwidth"}, "");
        file_.processors =
            json_.names(json_.member(root, "processors", ""), "processors", "processor");
        file_.graph.clear(processor_count());
        set_links();
        read_tasks(json_.member(root, "tasks", ""));
        if (root.contains("edges")) read_edges(root["edges"]);
        try {
            file_.graph.seal();
        } catch (const scheduler::GraphError& error) {
            json_.fail("edges", error.what());
        }
        return std::move(file_);
    }

private:
    ProcessorId processor_count() const {
        return static_cast<ProcessorId>(file_.processors.size());
    }

    void set_links() {
        const std::size_t count = file_.processors.size();
        const auto [latency, bandwidth] = read_links(json_, count, 1.0);
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
        json_.array(list, "tasks", "a list of tasks");
        if (list.empty()) json_.fail("tasks", "the graph is empty: at least one task is needed");
        for (std::size_t i = 0; i < list.size(); ++i)
            read_task(list[i], fmt::format("tasks[{}]", i));
    }

    void read_task(const json& task, const std::string& field) {
        if (!task.is_object()) {
            json_.fail(field, fmt::format("expected {{\"name\": ..., \"cost\": [...]}}, not {}",
                                          JsonFile::shown(task)));
        }
        json_.check_keys(task, {"name", "cost", "kind", "iteration"}, field + ".");
        const std::string own =
            json_.name(json_.member(task, "name", field + "."), field + ".name");
        if (ids_.contains(own)) {
            json_.fail(field + ".name", fmt::format("duplicate task '{}', the same as tasks[{}]",
                                                    own, ids_.at(own)));
        }
        const std::string cost_field = field + ".cost";
        const json& list = json_.array(json_.member(task, "cost", field + "."), cost_field,
                                       "a list with one number or null per processor");
        if (list.size() != processor_count()) {
            json_.fail(cost_field, fmt::format("task '{}' has {} costs for {} processors", own,
                                               list.size(), processor_count()));
        }
        std::vector<double> cost;
        for (std::size_t p = 0; p < list.size(); ++p) {
            cost.push_back(list[p].is_null()
                               ? scheduler::kCannotRun
                               : json_.number(list[p], fmt::format("{}[{}]", cost_field, p),
                                              "a finite number >= 0, or null where it cannot run"));
        }
        if (std::ranges::all_of(cost, [](double c) { return c == scheduler::kCannotRun; })) {
            json_.fail(cost_field, fmt::format("no processor can run task '{}'", own));
        }
        ids_[own] = file_.graph.add_task(cost, {.kind = trait(task, "kind", field),
                                                .iteration = trait(task, "iteration", field),
                                                .name = own});
        names_.push_back(own);
    }

    /// A whole number that a task may have; -1 without.
    int trait(const json& task, const std::string& key, const std::string& field) const {
        if (!task.contains(key)) return -1;
        const json& value = task[key];
        constexpr int kLargest = std::numeric_limits<int>::max();
        if (!value.is_number_unsigned() || value.get<std::uint64_t>() > kLargest) {
            json_.fail(field + "." + key,
                       fmt::format("expected a whole number >= 0, not {}", JsonFile::shown(value)));
        }
        return value.get<int>();
    }

    void read_edges(const json& list) {
        json_.array(list, "edges", "a list of [from, to, data]");
        for (std::size_t i = 0; i < list.size(); ++i) {
            const std::string field = fmt::format("edges[{}]", i);
            const json& edge = list[i];
            if (!edge.is_array() || edge.size() != 3) {
                json_.fail(field, fmt::format("expected [\"from\", \"to\", data], not {}",
                                              JsonFile::shown(edge)));
            }
            const TaskId from = task_named(edge[0], field + "[0]");
            const TaskId to = task_named(edge[1], field + "[1]");
            file_.graph.add_edge(from, to,
                                 json_.number(edge[2], field + "[2]", "a finite number >= 0"));
        }
    }

    TaskId task_named(const json& value, const std::string& field) const {
        const std::string wanted = json_.name(value, field);
        const auto found = ids_.find(wanted);
        if (found != ids_.end()) return found->second;
        const std::string near = near_miss(wanted, names_);
        json_.fail(field,
                   fmt::format("unknown task '{}'{}{}", wanted, near.empty() ? "" : "; ", near));
    }

    JsonFile json_;
    GraphFile file_;
    std::unordered_map<std::string, TaskId> ids_;
    std::vector<std::string> names_;
};

}  // namespace

GraphFile read_graph_file(const std::string& path) { return GraphReader(path).read(); }

}  // namespace weft
