#include "simulation/choice/machine_forecast.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "runtime/planning/placement.h"

namespace weft {

TimingModel with_exchanges(const TimingModel& timing, std::size_t kinds, std::size_t devices) {
    constexpr std::size_t kMore = 2;  // copying, merging
    TimingModel more(kinds + kMore, devices);
    for (std::uint32_t d = 0; d < devices; ++d) {
        for (std::uint32_t kind = 0; kind < kinds + kMore; ++kind) {
            const std::uint32_t like = kind < kinds ? kind : 0;
            more.costs().restore(kind, d, timing.costs().fit(like, d));
        }
        for (std::uint32_t to = 0; to < devices; ++to) {
            more.set_link(static_cast<int>(d), static_cast<int>(to),
                          timing.link(static_cast<int>(d), static_cast<int>(to)));
        }
    }
    return more;
}

Forecaster::Forecaster(Solver& maker, const std::vector<Solver*>& asyncs, int strip_count,
                       int devices)
    : strip_count_(strip_count),
      devices_(static_cast<std::size_t>(devices)),
      kinds_(maker.kinds().size()),
      graphs_(maker, devices_.size()) {
    std::iota(devices_.begin(), devices_.end(), 0);
    for (Solver* async : asyncs) {
        async_graphs_.push_back(std::make_unique<StepGraphs>(*async, devices_.size()));
    }
}

/// In the step's own order, every task on the device that has its strips.
double Forecaster::time(StepGraphs& graphs, const Division& division, const TimingModel& timing) {
    std::vector<int> parts;
    std::vector<unsigned> allowed;
    for (const int d : division.devices()) {
        parts.push_back(division.strips[static_cast<std::size_t>(d)]);
        allowed.push_back(1U << d);
    }
    const auto graph = graphs.of(parts);
    const scheduler::TaskGraph& priced = graph->price(timing, allowed);
    in_order_.schedule(priced, plan_);
    cost_.clear();
    for (scheduler::TaskId t = 0; t < priced.task_count(); ++t) {
        cost_.push_back(priced.cost(t, plan_.placements[t].processor));
    }
    return timetable_.period(priced, plan_, cost_, graph->carried());
}

double Forecaster::best_mixture(StepGraphs& graphs, const TimingModel& timing) {
    if (devices_.size() < 2 || strip_count_ < 2) return Forecast::kNever;
    std::map<Division, double> known;
    const auto predict = [&](const Division& division) {
        const auto [entry, is_new] = known.try_emplace(division);
        if (is_new) entry->second = time(graphs, division, timing);
        return entry->second;
    };
    const DivisionSearch search(static_cast<int>(devices_.size()), strip_count_, devices_, predict);
    Division mixture = search.by_speed();
    while (search.improve(mixture, 0.0)) {
    }
    return mixture.devices().size() < 2 ? Forecast::kNever : predict(mixture);
}

/// As long as attempts are left to make; they end by themselves, but do not say so.
double Forecaster::best_placement(const TimingModel& timing) {
    constexpr int kAttempts = 60;
    Placement placement(graphs_, strip_count_, devices_);
    if (devices_.size() < 2 || !placement.possible()) return Forecast::kNever;
    const auto step = graphs_.of({strip_count_});
    for (int i = 0; i < kAttempts; ++i) placement.improve(step->step(), timing);
    return placement.known() ? placement.period() : Forecast::kNever;
}

double Forecaster::async_time(std::size_t form, const Division& division,
                              const TimingModel& timing) {
    return time(*async_graphs_[form], division, with_exchanges(timing, kinds_, devices_.size()));
}

Forecast Forecaster::forecast(const TimingModel& timing) {
    Forecast forecast;
    for (const int d : devices_) {
        const auto alone = Division::single(static_cast<int>(devices_.size()), strip_count_, d);
        forecast.single = std::min(forecast.single, time(graphs_, alone, timing));
    }
    forecast.exact = best_mixture(graphs_, timing);
    forecast.placed = best_placement(timing);
    const TimingModel more = with_exchanges(timing, kinds_, devices_.size());
    for (const auto& graphs : async_graphs_) {
        forecast.async.push_back(best_mixture(*graphs, more));
    }
    return forecast;
}

}  // namespace weft
