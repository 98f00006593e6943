#pragma once

#include <cstdint>
#include <vector>

#include "runtime/launch.h"
#include "runtime/numbers.h"

namespace weft {

/// A part of a buffer that a task reads, or reads and writes, in units of the buffer: elements, or,
/// where `segments` is given, strips of that table (all colours of them).
struct Access {
    BufferStorage* buffer = nullptr;
    const Segments* segments = nullptr;
    int begin = 0;
    int end = 0;
    bool writes = false;
};

/// One schedulable step: a body over a range of strips, with its read and write sets.
struct Task {
    const TaskBody* body = nullptr;
    int iteration = 0;
    int first_strip = 0;
    int end_strip = 0;
    RegionId region{};  ///< tasks of one region share most of their data
    long items = 0;
    std::vector<Access> accesses;
};

struct Dependency {
    int from = 0;
    int to = 0;
    double bytes = 0.0;  ///< what `to` reads of what `from` wrote
};

/// A task graph that runs several times in a row (the substep of a frame). Tasks are added in an
/// order in which they could run one after the other; what depends on what follows from their
/// accesses. Throws Misuse for what cannot be: an access outside its buffer, strips that a launch
/// does not have, one buffer in units of two kinds, tasks after seal().
class Step {
public:
    /// Adds a task; chain .reads(), .updates() on the result at once. Bodies, buffers and strip
    /// tables must outlive the step, so temporaries of them do not compile.
    class Adding {
    public:
        Adding(Step& step, int task) : step_(step), task_(task) {}
        Adding& reads(BufferStorage& buffer, int begin, int end);
        Adding& reads(BufferStorage& buffer, const Segments& strips);
        /// The items of other strips than its own.
        Adding& reads(BufferStorage& buffer, const Segments& strips, int begin, int end);
        Adding& reads(BufferStorage& buffer, const Segments&& strips) = delete;
        Adding& reads(BufferStorage& buffer, const Segments&& strips, int begin, int end) = delete;
        /// All of it, of which each instance needs rows of its own: the step can then be run for no
        /// more instances than there are rows.
        Adding& reads_by_instance(BufferStorage& buffer, int elements_per_instance = 1);
        Adding& updates(BufferStorage& buffer, int begin, int end);
        Adding& updates(BufferStorage& buffer, const Segments& strips);
        Adding& updates(BufferStorage& buffer, const Segments&& strips) = delete;

    private:
        Adding& access(const Access& access);
        Step& step_;
        int task_;
    };
    /// Adds a copy of a task of another step.
    void add(const Task& task);
    Adding add(const TaskBody& body, int iteration, StripRange strips, RegionId region = {});
    Adding add(const TaskBody&& body, int iteration, StripRange strips,
               RegionId region = {}) = delete;

    /// Finds the dependencies; call once, when all tasks are there.
    void seal();
    bool sealed() const { return sealed_; }

    const std::vector<Task>& tasks() const { return tasks_; }
    /// Within one instance.
    const std::vector<Dependency>& dependencies() const { return dependencies_; }
    /// From tasks of one instance to tasks of the next.
    const std::vector<Dependency>& carried() const { return carried_; }

    /// A buffer that has rows for so many instances only.
    struct InstanceLimit {
        const BufferStorage* buffer = nullptr;
        int elements_per_instance = 1;
    };
    const std::vector<InstanceLimit>& instance_limits() const { return limits_; }
    void add_instance_limit(const InstanceLimit& limit) { limits_.push_back(limit); }

private:
    void refuse_if_sealed() const;

    std::vector<Task> tasks_;
    std::vector<Dependency> dependencies_;
    std::vector<Dependency> carried_;
    std::vector<InstanceLimit> limits_;
    bool sealed_ = false;
};

}  // namespace weft
