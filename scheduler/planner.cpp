#include "scheduler/planner.h"

#include <array>
#include <stdexcept>
#include <string>

#include "scheduler/cpop.h"
#include "scheduler/heft.h"
#include "scheduler/hps.h"
#include "scheduler/in_order.h"
#include "scheduler/lookahead.h"
#include "scheduler/optimal.h"
#include "scheduler/peft.h"
#include "scheduler/portfolio.h"
#include "scheduler/single.h"

namespace weft::scheduler {
namespace {

struct Entry {
    std::string_view name;
    std::unique_ptr<Planner> (*make)();
};

template <class P>
std::unique_ptr<Planner> make() {
    return std::make_unique<P>();
}

std::unique_ptr<Planner> make_heft_gs() { return std::make_unique<Heft>(Heft::Rank::kGaussSeidel); }

constexpr std::array kPlanners{
    Entry{"heft", make<Heft>},
    Entry{"peft", make<Peft>},
    Entry{"cpop", make<Cpop>},
    Entry{"lookahead", make<Lookahead>},
    Entry{"hps", make<Hps>},
    Entry{"single", make<Single>},
    Entry{"heft-gs", make_heft_gs},
    Entry{"in-order", make<InOrder>},
    Entry{"portfolio", make<Portfolio>},
    Entry{"optimal", make<Optimal>},
};

constexpr auto kNames = [] {
    std::array<std::string_view, kPlanners.size()> names;
    for (std::size_t i = 0; i < names.size(); ++i) names[i] = kPlanners[i].name;
    return names;
}();

}  // namespace

std::span<const std::string_view> planner_names() { return kNames; }

std::unique_ptr<Planner> make_planner(std::string_view name) {
    for (const Entry& entry : kPlanners) {
        if (entry.name == name) return entry.make();
    }
    std::string message = "there is no planner '" + std::string(name) + "'; there are";
    for (const std::string_view known : kNames) message += ' ' + std::string(known);
    throw std::invalid_argument(message);
}

}  // namespace weft::scheduler
