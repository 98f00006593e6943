#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/weft/cli_support.h"
#include "apps/weft/commands.h"
#include "apps/weft/graph_file.h"
#include "apps/weft/plan_text.h"
#include "scheduler/optimal.h"
#include "scheduler/planner.h"
#include "scheduler/portfolio.h"

namespace weft {
namespace {

using nlohmann::ordered_json;
using scheduler::Plan;
using scheduler::Planner;
using scheduler::TaskId;

// For one plan at leisure, unlike the runtime's one per frame.
constexpr std::uint32_t kPortfolioEvaluations = 20000;

struct PlanOptions {
    std::string graph;
    std::string algorithm = "portfolio";
    double time_limit = 10.0;  // s
    bool compare = false;
    bool json = false;
};

struct TimedPlan {
    Plan plan;
    double seconds = 0.0;
};

std::vector<std::string> algorithm_names() {
    return {scheduler::planner_names().begin(), scheduler::planner_names().end()};
}

std::unique_ptr<Planner> planner_for(const std::string& name, double time_limit) {
    if (name == "optimal") {
        return std::make_unique<scheduler::Optimal>(
            scheduler::SearchLimit{.nodes = ~std::uint64_t{0}, .seconds = time_limit});
    }
    if (name == "portfolio") {
        return std::make_unique<scheduler::Portfolio>(scheduler::PortfolioBudget{
            .evaluations = kPortfolioEvaluations, .seconds = time_limit});
    }
    return scheduler::make_planner(name);
}

TimedPlan make_plan(const GraphFile& file, const std::string& algorithm, double time_limit) {
    TimedPlan result;
    const auto begin = std::chrono::steady_clock::now();
    planner_for(algorithm, time_limit)->plan(file.graph, result.plan);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    result.seconds = took.count();
    return result;
}

std::string verdict(const Plan& plan) {
    if (plan.proven_optimal) return "optimal";
    return plan.gave_up ? "gave up at its limit" : "";
}

ordered_json summary_json(const TimedPlan& result) {
    const Plan& plan = result.plan;
    return {{"algorithm", plan.algorithm},
            {"found_by", plan.found_by},
            {"makespan", plan.makespan},
            {"lower_bound", plan.lower_bound()},
            {"path_bound", plan.path_bound},
            {"area_bound", plan.area_bound},
            {"gap", plan.gap()},
            {"proven_optimal", plan.proven_optimal},
            {"gave_up", plan.gave_up},
            {"plan_us", 1e6 * result.seconds}};
}

void print_json(const GraphFile& file, const TimedPlan& result) {
    ordered_json json = summary_json(result);
    json["tasks"] = ordered_json::array();
    for (TaskId t = 0; t < file.graph.task_count(); ++t) {
        const scheduler::Placement& own = result.plan.placements[t];
        json["tasks"].push_back({{"name", file.graph.name(t)},
                                 {"processor", file.processors[own.processor]},
                                 {"start", own.start},
                                 {"end", own.end}});
    }
    std::cout << json.dump(2) << '\n';
}

void print_text(const GraphFile& file, const TimedPlan& result) {
    const Plan& plan = result.plan;
    std::cout << plan_table(file, plan) << '\n' << plan_gantt(file, plan) << '\n';
    const std::string part =
        plan.found_by == plan.algorithm ? "" : fmt::format(" (found by {})", plan.found_by);
    const std::string note = verdict(plan);
    std::cout << fmt::format("algorithm    {}{}\n", plan.algorithm, part)
              << fmt::format("makespan     {:.8g}{}\n", plan.makespan,
                             note.empty() ? "" : ", " + note)
              << fmt::format("lower bound  {:.8g} (path {:.8g}, area {:.8g})\n", plan.lower_bound(),
                             plan.path_bound, plan.area_bound)
              << fmt::format("gap          {:.1f} %\n", 100.0 * plan.gap());
}

void print_comparison(const GraphFile& file, const PlanOptions& options) {
    std::vector<TimedPlan> rows;
    for (const std::string& name : algorithm_names()) {
        rows.push_back(make_plan(file, name, options.time_limit));
    }
    double bound = 0.0;  // one row may prove more than the others
    for (const TimedPlan& row : rows) bound = std::max(bound, row.plan.lower_bound());
    if (options.json) {
        ordered_json json{{"processors", file.processors},
                          {"tasks", file.graph.task_count()},
                          {"edges", file.graph.edge_count()},
                          {"lower_bound", bound},
                          {"rows", ordered_json::array()}};
        for (const TimedPlan& row : rows) json["rows"].push_back(summary_json(row));
        std::cout << json.dump(2) << '\n';
        return;
    }
    const Plan& first = rows.front().plan;
    std::cout << fmt::format("{} tasks, {} edges, {} processors\n", file.graph.task_count(),
                             file.graph.edge_count(), file.processors.size())
              << fmt::format("lower bound {:.8g} (path {:.8g}, area {:.8g})\n\n", bound,
                             first.path_bound, first.area_bound)
              << fmt::format("{:<10} {:>14} {:>12} {:>12}\n", "algorithm", "makespan",
                             "above bound", "planning");
    for (const TimedPlan& row : rows) {
        const double above = bound > 0.0 ? 100.0 * (row.plan.makespan / bound - 1.0) : 0.0;
        const std::string line =
            fmt::format("{:<10} {:>14.8g} {:>10.1f} % {:>9.1f} us  {}", row.plan.algorithm,
                        row.plan.makespan, above, 1e6 * row.seconds, verdict(row.plan));
        std::cout << line.substr(0, line.find_last_not_of(' ') + 1) << '\n';
    }
}

void plan_graph(const PlanOptions& options) {
    const GraphFile file = read_graph_file(options.graph);
    if (options.compare) return print_comparison(file, options);
    const TimedPlan result = make_plan(file, options.algorithm, options.time_limit);
    if (options.json) {
        print_json(file, result);
    } else {
        print_text(file, result);
    }
}

}  // namespace

void add_plan_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("plan", "Schedule a task graph on any processors");
    command->footer(
        "GRAPH.json holds processors, tasks with their cost on each, and edges with the time that\n"
        "their data take from one processor to another:\n"
        "  {\"processors\": [\"cpu\", \"gpu\"],\n"
        "   \"tasks\": [{\"name\": \"a\", \"cost\": [14, 16]}, {\"name\": \"b\", \"cost\": [13, "
        "null]}],\n"
        "   \"edges\": [[\"a\", \"b\", 18]]}\n\n"
        "Examples:\n"
        "  weft plan graph.json\n"
        "  weft plan graph.json --compare");
    const auto options = std::make_shared<PlanOptions>();
    command->add_option("GRAPH", options->graph, "task graph (.json)")
        ->required()
        ->type_name("FILE");
    const std::vector<std::string> names = algorithm_names();
    command
        ->add_option("--algorithm", options->algorithm, fmt::format("{}", fmt::join(names, ", ")))
        ->type_name("NAME")
        ->check(one_of(names))
        ->capture_default_str();
    command->add_flag("--compare", options->compare,
                      "a table of all algorithms, whatever --algorithm says");
    command
        ->add_option("--time-limit", options->time_limit,
                     "seconds after which portfolio and optimal settle for the best plan so far")
        ->type_name("SECONDS")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command->add_flag("--json", options->json, "print one JSON document");
    command->callback([options] { plan_graph(*options); });
}

}  // namespace weft
