#include "simulation/solver/async_iterates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/descent/substep.h"
#include "kernels/exchange.h"
#include "runtime/error.h"
#include "scheduler/assert.h"
#include "simulation/solver/iterate_cells.h"

namespace weft {

namespace {

/// What maps of divisions need, and some more, so that no device waits for a slot: the longer
/// values are on their way, the more of them there are.
int slots_for(const AsyncSettings& settings) {
    constexpr int kMost = 40;
    if (settings.tasks == AsyncSettings::Tasks::kKinds) return kMost;
    const int iterations = static_cast<int>(std::ceil(settings.wait_or_default()));
    return std::min(kMost, 4 + (settings.dropping ? 5 : 8) * iterations);
}

}  // namespace

AsyncIterates::AsyncIterates(const Model& model, std::unique_ptr<Solver> solver, int iterates,
                             const AsyncSettings& settings)
    : model_(model),
      settings_(settings),
      solver_(std::move(solver)),
      copy_kind_(static_cast<int>(solver_->kinds().size())),
      merge_kind_(copy_kind_ + 1),
      iterates_(model, *solver_, iterates, slots_for(settings)) {
    if (solver_->asynchrony().kinds.empty()) {
        throw UserError(
            "--plan async: the scene's solver has no asynchronous form; xpbd, vbd, sosd "
            "and jpgd have one where triangles have room for no obstacle");
    }
    if (model.scene.contact) check_contact();
    add_exchanges();
}

/// What keeps surfaces apart has the last word over all that devices have made of each other.
void AsyncIterates::check_contact() const {
    if (settings_.settle == 0) {
        throw UserError(
            "--async settle=0: with [contact] at least the last iteration is in step, or surfaces "
            "might pass through each other");
    }
    if (by_kinds()) {
        throw UserError("--async tasks=kinds: [contact] is not told apart by kinds yet");
    }
}

/// All that maps may ask for: an executor has to know them before there is a map.
void AsyncIterates::add_exchanges() {
    const int iterates = iterates_.count();
    const int places = iterates_.place_count();
    for (std::size_t b = 0; b < iterates_.buffer_count(); ++b) {
        for (int from = 0; from < places; ++from) {
            for (int to = 0; to < places; ++to) {
                const bool is_between_slots = from >= iterates && to >= iterates;
                if (from == to || is_between_slots) continue;
                add_copy(b, from, to);
                for (int start = iterates; to < iterates && start < places; ++start) {
                    if (start != from) add_merge(b, start, from, to);
                }
            }
        }
    }
}

void AsyncIterates::add_copy(std::size_t buffer, int from, int to) {
    exchanges_[{buffer, kCopies, from, to}] = std::make_unique<TaskBody>(
        TaskBody{"exchange",
                 copy_kind_,
                 {launch(kernels::copy_positions, iterates_.pieces(), iterates_.in(buffer, from),
                         iterates_.in(buffer, to))}});
}

void AsyncIterates::add_merge(std::size_t buffer, int start, int from, int to) {
    using Merge = AsyncSettings::Merge;
    Buffer<float4>& own = iterates_.in(buffer, to);
    Buffer<float4>& input = iterates_.in(buffer, from);
    float weight = solver_->asynchrony().weight;
    if (settings_.merge == Merge::kSum) weight = 1.0f;
    if (settings_.merge == Merge::kMean) weight = 0.5f;
    TaskBody body{"merge", merge_kind_, {}};
    if (settings_.merge == Merge::kPosition)
        body.launches = {launch(kernels::average_positions, iterates_.pieces(), own, input)};
    else
        body.launches = {launch(kernels::merge_displacements, iterates_.pieces(), own,
                                iterates_.in(buffer, start), input, weight, weight)};
    exchanges_[{buffer, start, from, to}] = std::make_unique<TaskBody>(std::move(body));
}

std::vector<const TaskBody*> AsyncIterates::bodies() const {
    std::vector<const TaskBody*> list = solver_->bodies();
    for (const TaskBody* body : iterates_.other_bodies()) list.push_back(body);
    for (const auto& [places, body] : exchanges_) list.push_back(body.get());
    return list;
}

std::vector<std::string> AsyncIterates::kinds() const {
    std::vector<std::string> names = solver_->kinds();
    names.emplace_back("exchange");
    names.emplace_back("merge");
    return names;
}

bool AsyncIterates::is_asynchronous(const Task& task) const {
    const bool has_last_word = model_.obstacles || model_.scene.contact;
    const int settle = settings_.settle.value_or(has_last_word ? 1 : 0);
    if (task.iteration >= model_.scene.solver.iterations - settle) return false;
    const Asynchrony asynchrony = solver_->asynchrony();
    if (task.iteration % asynchrony.round < asynchrony.in_step) return false;
    return std::ranges::count(asynchrony.kinds, task.body->kind) > 0;
}

namespace {

/// In a partition by the devices' speeds, the fastest one.
int largest_part(const Partition& partition) {
    const auto size = [](const Part& part) { return part.end - part.begin; };
    return static_cast<int>(std::ranges::max_element(partition.parts, {}, size) -
                            partition.parts.begin());
}

/// Tasks that follow each other for what is not of the iterate. [task]
std::vector<std::vector<int>> order_by_other_data(const Step& step, const Iterates& iterates) {
    Step other;
    for (Task task : step.tasks()) {
        std::erase_if(task.accesses, [&](const Access& access) {
            return iterates.index_of(access.buffer) < iterates.buffer_count();
        });
        other.add(task);
    }
    other.seal();
    std::vector<std::vector<int>> after(step.tasks().size());
    for (const Dependency& d : other.dependencies()) {
        after[static_cast<std::size_t>(d.to)].push_back(d.from);
    }
    return after;
}

/// A division is made so that all devices take equally long. So by plan an iteration takes each of
/// them a time of 1, and its tasks share it by their items.
std::vector<double> planned_durations(const Step& step, std::size_t parts, int iterations) {
    std::vector<double> items(parts, 0.0);
    for (const Task& task : step.tasks()) {
        items[index(task.region)] += static_cast<double>(task.items);
    }
    std::vector<double> durations;
    for (const Task& task : step.tasks()) {
        const double all = items[index(task.region)];
        durations.push_back(static_cast<double>(task.items) * iterations / all);
    }
    return durations;
}

/// Tasks by kinds: the speeds are those that the parts were cut by, so an iteration takes the time
/// 1 if all share in it evenly. What is synchronous is the largest part's. [task][device]
std::vector<std::vector<double>> durations_by_device(const Step& step, const Partition& partition,
                                                     const std::vector<bool>& is_asynchronous,
                                                     int iterations) {
    double items = 0.0;
    for (const Task& task : step.tasks()) items += static_cast<double>(task.items);
    const double unit = iterations * static_cast<double>(partition.strip_count()) / items;
    const auto main = static_cast<std::size_t>(largest_part(partition));
    std::vector<std::vector<double>> durations;
    for (std::size_t t = 0; t < step.tasks().size(); ++t) {
        const long own = std::max(step.tasks()[t].items, 1L);
        auto& row = durations.emplace_back();
        for (std::size_t d = 0; d < partition.parts.size(); ++d) {
            const Part& part = partition.parts[d];
            const bool can_run = is_asynchronous[t] || d == main;
            row.push_back(can_run ? unit * static_cast<double>(own) / (part.end - part.begin)
                                  : std::numeric_limits<double>::infinity());
        }
    }
    return durations;
}

}  // namespace

/// A cell's owner has its strips; where nobody has strips, the fastest one has it all, as the
/// paper's main device.
std::vector<int> AsyncIterates::owners_of(const Partition& partition,
                                          const IterateCells& cells) const {
    std::vector<int> owners;
    for (const auto& cell : cells.cells()) {
        const int strip =
            cell.first_piece % iterates_.pieces_per_half() / Iterates::kPiecesPerStrip;
        const auto part =
            std::ranges::find_if(partition.parts, [&](const Part& p) { return strip < p.end; });
        owners.push_back(by_kinds() ? largest_part(partition)
                                    : static_cast<int>(part - partition.parts.begin()));
    }
    return owners;
}

/// What of its iteration a task must have seen: all before it has smaller ones.
int AsyncIterates::stage_of(const Task& task, int number) const {
    if (settings_.order == AsyncSettings::Order::kAcross) return number;
    if (settings_.order == AsyncSettings::Order::kFree) return 0;
    return std::ranges::count(solver_->asynchrony().last, task.body->kind) > 0 ? 1 : 0;
}

void AsyncIterates::place_kinds(const Step& step, const Partition& partition,
                                scheduler::ExchangeProblem& problem) const {
    std::vector<bool> is_asynchronous;
    for (const auto& task : problem.tasks) is_asynchronous.push_back(!task.synchronous);
    scheduler::place_by_rank(
        problem,
        durations_by_device(step, partition, is_asynchronous, model_.scene.solver.iterations),
        settings_.rank ? scheduler::PlacingRank::kGaussSeidel : scheduler::PlacingRank::kUpward);
}

scheduler::ExchangeProblem AsyncIterates::problem_of(const Step& step, const Partition& partition,
                                                     const IterateCells& cells) const {
    scheduler::ExchangeProblem problem;
    problem.devices = static_cast<int>(partition.parts.size());
    problem.window = settings_.window;
    problem.iterations_in_turn = settings_.order == AsyncSettings::Order::kWithin;
    problem.wait = settings_.wait_or_default();
    problem.dropping = settings_.dropping;
    problem.most_slots = iterates_.place_count() - iterates_.count();
    problem.owners = owners_of(partition, cells);
    const auto after = order_by_other_data(step, iterates_);
    for (std::size_t t = 0; t < step.tasks().size(); ++t) {
        const Task& task = step.tasks()[t];
        auto& planned = problem.tasks.emplace_back();
        planned.iteration = task.iteration;
        planned.stage = stage_of(task, static_cast<int>(t));
        if (by_kinds()) planned.kind = task.body->kind;
        planned.device = static_cast<int>(task.region);
        planned.synchronous = !is_asynchronous(task);
        planned.after = after[t];
        for (const Access& access : task.accesses) {
            const std::size_t buffer = iterates_.index_of(access.buffer);
            if (buffer == iterates_.buffer_count()) continue;
            planned.reads.push_back(cells.of(buffer, access));
            if (access.writes) planned.writes.push_back(planned.reads.back());
        }
    }
    if (by_kinds()) {
        place_kinds(step, partition, problem);
        return problem;
    }
    scheduler::plan_in_turn(
        problem, planned_durations(step, partition.parts.size(), model_.scene.solver.iterations));
    return problem;
}

scheduler::ExchangeProblem AsyncIterates::problem_of(const Partition& partition) {
    const Step step = base_step(partition);
    return problem_of(step, partition, IterateCells(iterates_, step, partition));
}

/// What the synchronous solver does.
Step AsyncIterates::base_step(const Partition& partition) {
    if (!by_kinds()) return solver_->make_step(partition);
    if (partition.parts.size() > 2) {
        throw UserError(
            fmt::format("--async tasks=kinds: two devices can share kinds of tasks, here are {}; "
                        "tasks=strips takes any number",
                        partition.parts.size()));
    }
    return solver_->make_step(Partition::whole(partition.strip_count()));
}

/// Puts a map's steps into a Step.
class AsyncIterates::Building {
public:
    /// devices: of the map
    Building(const AsyncIterates& solver, const Step& base, const IterateCells& cells, int devices)
        : solver_(solver), base_(base), cells_(cells), devices_(devices) {}

    Step build(const scheduler::ExchangeMap& map) {
        for (const scheduler::ExchangeStep& step : map.steps) {
            if (step.kind == scheduler::ExchangeStep::Kind::kTask)
                add_task(base_.tasks()[static_cast<std::size_t>(step.task)], step.device);
            else
                add_exchange(step);
        }
        step_.seal();
        return std::move(step_);
    }

private:
    void add_task(const Task& task, int device) {
        const Iterates& iterates = solver_.iterates_;
        Task own = task;
        own.region = RegionId{device};
        own.body = &iterates.body_for(*task.body, device);
        for (Access& access : own.accesses) {
            const std::size_t buffer = iterates.index_of(access.buffer);
            if (buffer < iterates.buffer_count()) access.buffer = &iterates.in(buffer, device);
        }
        step_.add(own);
    }

    /// One task for the cells of each buffer that lie side by side.
    void add_exchange(const scheduler::ExchangeStep& step) {
        const auto& cells = cells_.cells();
        for (int c = step.cells.begin; c < step.cells.end;) {
            const auto& first = cells[static_cast<std::size_t>(c)];
            int end_piece = first.end_piece;
            for (++c; c < step.cells.end; ++c) {
                const auto& next = cells[static_cast<std::size_t>(c)];
                if (next.buffer != first.buffer) break;
                end_piece = next.end_piece;
            }
            add_exchange(step, first.buffer, first.first_piece, end_piece);
        }
    }

    /// A map's slots lie behind the iterates of its devices; there may be more iterates than these.
    int place_of(int place) const {
        return place < devices_ ? place : place - devices_ + solver_.iterates_.count();
    }

    void add_exchange(const scheduler::ExchangeStep& step, std::size_t buffer, int begin, int end) {
        const Iterates& iterates = solver_.iterates_;
        const int start = place_of(step.start);
        const int from = place_of(step.from);
        const int to = place_of(step.to);
        const int first = iterates.pieces().item(begin);
        const int last = iterates.pieces().item(end);
        if (first == last) return;
        const bool merges = step.kind == scheduler::ExchangeStep::Kind::kMerge;
        const auto body = solver_.exchanges_.find({buffer, merges ? start : kCopies, from, to});
        WEFT_ASSERT(body != solver_.exchanges_.end());
        auto task =
            step_.add(*body->second, iteration_of(step), {begin, end}, RegionId{step.device});
        task.reads(iterates.in(buffer, from), first, last)
            .updates(iterates.in(buffer, to), first, last);
        if (merges) task.reads(iterates.in(buffer, start), first, last);
    }

    int iteration_of(const scheduler::ExchangeStep& step) const {
        const auto number = std::min(static_cast<std::size_t>(step.task), base_.tasks().size() - 1);
        return base_.tasks()[number].iteration;
    }

    const AsyncIterates& solver_;
    const Step& base_;
    const IterateCells& cells_;
    int devices_;
    Step step_;
};

/// Start points that no device was ever at are needed where three share a cell, and nowhere do
/// more than two.
scheduler::ExchangeMap AsyncIterates::map_of(const scheduler::ExchangeProblem& problem) const {
    try {
        auto map = scheduler::make_exchange_map(problem);
        WEFT_ASSERT(map.virtual_starts == 0);
        return map;
    } catch (const scheduler::TooFewSlots&) {
        throw UserError(
            fmt::format("--async {}: so much would have to be kept for later that there "
                        "is no room; a smaller wait or dropping=on may help",
                        to_text(settings_)));
    }
}

Step AsyncIterates::make_step(const Partition& partition) {
    WEFT_ASSERT(static_cast<int>(partition.parts.size()) <= iterates_.count());
    Step base = base_step(partition);
    if (partition.parts.size() == 1) return base;
    const IterateCells cells(iterates_, base, partition);
    const auto problem = problem_of(base, partition, cells);
    const auto map = map_of(problem);
    WEFT_ASSERT(scheduler::find_fault(problem, map).empty());
    return Building(*this, base, cells, problem.devices).build(map);
}

}  // namespace weft
