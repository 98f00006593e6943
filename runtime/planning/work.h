#pragma once

#include <deque>
#include <initializer_list>
#include <string>
#include <vector>

#include "runtime/planning/step_maker.h"

namespace weft {

/// All that a Runner needs to know of what it runs.
class Work : public StepMaker {
public:
    /// How many strips there are to share among devices; no fewer than 1.
    virtual int strip_count() const = 0;
    /// The buffers whose contents one frame hands to the next: what is taken back when a frame has
    /// to be done again. None: all that the steps write.
    virtual std::vector<BufferStorage*> carried() const { return {}; }
};

/// Stages that follow each other, each over all strips: what most simulations by grids and meshes
/// are. A device's share of the strips is cut into tasks so that what other devices wait for comes
/// first.
///
///     weft::StripWork work(strip_count);
///     work.add("diffuse", weft::launch(heat::diffuse, rows, old, fresh, width, rate))
///         .reads(old, rows, 1)     // its own strips, and one more on either side
///         .updates(fresh, rows);
///
/// What a stage writes belongs to its own strips, and a launch must be able to run on all strips at
/// the same time: a stage reads no neighbour's data that it writes itself (Misuse). A stage says
/// every buffer that its kernels get, or a Runner refuses the work.
class StripWork final : public Work {
public:
    explicit StripWork(int strip_count);

    /// The accesses of a stage; chain them at once.
    class Stage {
    public:
        Stage(StripWork& work, std::size_t number) : work_(work), number_(number) {}
        /// Each task reads the items of its strips, and of so many more on either side.
        Stage& reads(BufferStorage& buffer, const Segments& strips, int reach = 0);
        /// Each task reads all of it. Of a buffer that no stage writes; for others there is
        /// `reach`, which may be as far as there are strips.
        Stage& reads(BufferStorage& buffer);
        /// The same, but it has rows for each instance of the step within a frame, and a task reads
        /// those of its own: a frame of more instances than there are rows is refused.
        Stage& reads_by_instance(BufferStorage& buffer, int elements_per_instance = 1);
        /// Each task reads and writes the items of its strips.
        Stage& updates(BufferStorage& buffer, const Segments& strips);

    private:
        StripWork& work_;
        std::size_t number_;
    };
    /// launches  one after the other on each strip; each over as many strips as the work has.
    ///           Throws Misuse otherwise.
    Stage add(std::string name, std::vector<Launch> launches);
    Stage add(std::string name, Launch launch) {
        return add(std::move(name), std::vector<Launch>{std::move(launch)});
    }

    int strip_count() const override { return strip_count_; }
    std::vector<const TaskBody*> bodies() const override;
    std::vector<std::string> kinds() const override;
    Step make_step(const Partition& partition) override;

private:
    struct Part {
        BufferStorage* buffer = nullptr;
        Segments strips = {};
        int reach = 0;
        int per_instance = 0;
        bool writes = false;
        bool whole = false;
    };
    struct Description {
        TaskBody body;
        std::deque<Part> parts;  // a deque: accesses point to their strips
    };
    void add_task(Step& step, const Description& stage, StripRange strips, RegionId region) const;
    static void check_neighbours(const Description& stage);
    void check(const Segments& strips, const std::string& stage) const;
    int largest_reach() const;

    int strip_count_;
    std::deque<Description> stages_;  // a deque: steps point to the bodies
};

/// One step, as it is: its tasks are placed on devices one by one. What is worth cutting among
/// devices should be several tasks.
class StepWork final : public Work {
public:
    /// The step is copied; its bodies and buffers must outlive the work. What its tasks have as
    /// regions does not matter. Throws Misuse for a step without tasks, or one that is not sealed.
    explicit StepWork(const Step& step);

    int strip_count() const override { return strip_count_; }
    bool can_divide() const override { return false; }
    std::vector<const TaskBody*> bodies() const override;
    std::vector<std::string> kinds() const override;
    Step make_step(const Partition&) override;

private:
    std::vector<Task> tasks_;
    std::vector<Step::InstanceLimit> limits_;
    int strip_count_ = 0;
};

}  // namespace weft
