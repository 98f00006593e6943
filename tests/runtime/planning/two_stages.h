#pragma once

#include <vector>

#include "runtime/planning/step_maker.h"
#include "runtime/planning/timing_model.h"

namespace weft::test {

/// Work to be planned and never run: in each part of the strips a task of stage a, and one of stage
/// b that reads what a wrote there. Items are spread evenly over the strips.
class TwoStages final : public StepMaker {
public:
    TwoStages(int strips, int items_of_a, int items_of_b)
        : begin_a_("strips of a", static_cast<std::size_t>(strips) + 1),
          begin_b_("strips of b", static_cast<std::size_t>(strips) + 1),
          strips_a_(even_strips(begin_a_, items_of_a)),
          strips_b_(even_strips(begin_b_, items_of_b)),
          table_("table", 1000),
          written_by_a_("a", static_cast<std::size_t>(items_of_a)),
          written_by_b_("b", static_cast<std::size_t>(items_of_b)),
          a_{"a", 0, {Launch{nullptr, {}, strips_a_}}},
          b_{"b", 1, {Launch{nullptr, {}, strips_b_}}} {}

    std::vector<const TaskBody*> bodies() const override { return {&a_, &b_}; }
    std::vector<std::string> kinds() const override { return {"a", "b"}; }
    Step make_step(const Partition& partition) override {
        Step step;
        int region = 0;
        for (const Part& part : partition.parts) {
            step.add(a_, 0, part.strips(), RegionId{region})
                .reads(table_, 0, static_cast<int>(table_.count()))
                .updates(written_by_a_, strips_a_);
            step.add(b_, 0, part.strips(), RegionId{region})
                .reads(written_by_a_, strips_a_)
                .updates(written_by_b_, strips_b_);
            ++region;
        }
        step.seal();
        return step;
    }

    /// What both write, all strips together.
    double written_bytes() const {
        return static_cast<double>(written_by_a_.bytes() + written_by_b_.bytes());
    }

private:
    Buffer<int> begin_a_, begin_b_;
    Segments strips_a_, strips_b_;
    Buffer<float> table_, written_by_a_, written_by_b_;
    TaskBody a_, b_;
};

/// What an item takes, known beforehand.
/// seconds  [kind][device]
inline TimingModel known_times(const std::vector<std::vector<double>>& seconds) {
    TimingModel timing(seconds.size(), seconds[0].size());
    for (std::size_t kind = 0; kind < seconds.size(); ++kind) {
        for (std::size_t device = 0; device < seconds[kind].size(); ++device) {
            timing.costs().restore(static_cast<std::uint32_t>(kind),
                                   static_cast<std::uint32_t>(device),
                                   {{0.0, seconds[kind][device]}, 0.0, 10});
        }
    }
    return timing;
}

}  // namespace weft::test
