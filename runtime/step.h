#pragma once

#include <cstdint>
#include <vector>

#include "runtime/launch.h"

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
    int region = 0;  ///< tasks of one region share most of their data
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
/// accesses.
class Step {
public:
    /// Adds a task; chain .reads(), .updates() on the result at once.
    class Adding {
    public:
        Adding(Step& step, int task) : step_(step), task_(task) {}
        Adding& reads(BufferStorage& buffer, int begin, int end);
        Adding& reads(BufferStorage& buffer, const Segments& strips);
        /// Of other strips than the task's own.
        Adding& reads(BufferStorage& buffer, const Segments& strips, int begin, int end);
        Adding& updates(BufferStorage& buffer, int begin, int end);
        Adding& updates(BufferStorage& buffer, const Segments& strips);

    private:
        Adding& access(const Access& access);
        Step& step_;
        int task_;
    };
    /// Adds a copy of a task of another step.
    void add(const Task& task) { tasks_.push_back(task); }
    Adding add(const TaskBody& body, int iteration, int first_strip, int end_strip, int region);

    /// Finds the dependencies; call once, when all tasks are there.
    void seal();

    const std::vector<Task>& tasks() const { return tasks_; }
    /// Within one instance.
    const std::vector<Dependency>& dependencies() const { return dependencies_; }
    /// From tasks of one instance to tasks of the next.
    const std::vector<Dependency>& carried() const { return carried_; }

private:
    std::vector<Task> tasks_;
    std::vector<Dependency> dependencies_;
    std::vector<Dependency> carried_;
};

}  // namespace weft
