#pragma once

#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "scheduler/exchange_map.h"
#include "simulation/solver/async_settings.h"
#include "simulation/solver/iterates.h"

namespace weft {

class IterateCells;

/// A solver whose parts do not wait for each other: each works on an iterate of its own, and learns
/// what others did by a map that is fixed beforehand (scheduler/exchange_map.h). The results are
/// others than the solver's. They depend on the partition and on the settings, and on nothing else:
/// not on which devices do the parts, nor on when.
class AsyncIterates final : public Solver {
public:
    /// iterates: the most parts of a partition. The model must outlive this. Throws UserError for a
    /// solver that has no asynchronous form.
    AsyncIterates(const Model& model, std::unique_ptr<Solver> solver, int iterates,
                  const AsyncSettings& settings);

    std::vector<const TaskBody*> bodies() const override;
    std::vector<std::string> kinds() const override;
    std::vector<BufferStorage*> state() override { return solver_->state(); }
    std::vector<RowTable*> tables() override { return solver_->tables(); }
    ContactResponse* contact() override { return solver_->contact(); }
    std::vector<Buffer<float4>*> iterate() override { return solver_->iterate(); }
    int iterate_count() const override { return iterates_.count(); }
    std::vector<const Buffer<float4>*> other_iterates() const override {
        return iterates_.others();
    }
    Step make_step(const Partition& partition) override;

    const AsyncSettings& settings() const { return settings_; }

    /// What a partition's map is made from; for studies and tests.
    scheduler::ExchangeProblem problem_of(const Partition& partition);

private:
    class Building;

    /// Bodies of copies and merges: [buffer, from, to] and [buffer, start, from, to].
    using Bodies = std::map<std::tuple<std::size_t, int, int, int>, std::unique_ptr<TaskBody>>;
    static constexpr int kCopies = -1;  ///< for the start: there is none

    void check_contact() const;
    void add_exchanges();
    void add_copy(std::size_t buffer, int from, int to);
    void add_merge(std::size_t buffer, int start, int from, int to);
    scheduler::ExchangeProblem problem_of(const Step& step, const Partition& partition,
                                          const IterateCells& cells) const;
    bool by_kinds() const { return settings_.tasks == AsyncSettings::Tasks::kKinds; }
    Step base_step(const Partition& partition);
    std::vector<int> owners_of(const Partition& partition, const IterateCells& cells) const;
    int stage_of(const Task& task, int number) const;
    void place_kinds(const Step& step, const Partition& partition,
                     scheduler::ExchangeProblem& problem) const;
    scheduler::ExchangeMap map_of(const scheduler::ExchangeProblem& problem) const;
    bool is_asynchronous(const Task& task) const;

    const Model& model_;
    AsyncSettings settings_;
    std::unique_ptr<Solver> solver_;
    int copy_kind_;
    int merge_kind_;
    Iterates iterates_;
    Bodies exchanges_;
};

}  // namespace weft
