#include "apps/weft/plan/timed_plan.h"

#include <chrono>
#include <memory>

#include "scheduler/optimal.h"
#include "scheduler/planner.h"
#include "scheduler/portfolio.h"

namespace weft {
namespace {

using scheduler::Planner;

// For one plan at leisure, unlike the runtime's one per frame.
constexpr std::uint32_t kPortfolioEvaluations = 20000;

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

}  // namespace

std::vector<std::string> algorithm_names() {
    return {scheduler::planner_names().begin(), scheduler::planner_names().end()};
}

TimedPlan make_plan(const GraphFile& file, const std::string& algorithm, double time_limit) {
    TimedPlan result;
    const auto begin = std::chrono::steady_clock::now();
    planner_for(algorithm, time_limit)->plan(file.graph, result.plan);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    result.seconds = took.count();
    return result;
}

}  // namespace weft
