#include "runtime/planning/work_checks.h"

#include <algorithm>
#include <set>
#include <string>

#include "runtime/error.h"

namespace weft {

namespace {

std::string quoted(const std::string& name) { return "'" + name + "'"; }

bool is_written(kernels::Parameter parameter) {
    using enum kernels::Parameter;
    return parameter == kWriteFloat || parameter == kWriteInt || parameter == kWriteFloat4 ||
           parameter == kWriteOther;
}

void check_kind(const TaskBody& body, int kinds) {
    if (body.kind >= 0 && body.kind < kinds) return;
    throw Misuse("task body " + quoted(body.name) + " is of kind " + std::to_string(body.kind) +
                 ", and the work names " + std::to_string(kinds) + " kinds");
}

void check_alive(const TaskBody& body, const Launch& launch) {
    const bool all = std::ranges::all_of(launch.alive, [](const auto& alive) { return *alive; });
    if (all) return;
    throw Misuse("task body " + quoted(body.name) + ", kernel " +
                 quoted(std::string(launch.kernel->name)) +
                 ": a buffer that was given to launch() is gone; buffers and strip tables must "
                 "outlive the work");
}

long value_count(const Segments& strips) {
    return 1L + static_cast<long>(strips.strip_count) * strips.colour_count;
}

std::vector<int> values_of(const Segments& strips) {
    const int* first = strips.begin->data() + strips.first;
    return {first, first + value_count(strips)};
}

/// The values of a strip table have to be there, and to ascend.
void check_strips(const TaskBody& body, const Segments& strips) {
    if (strips.begin == nullptr)
        throw Misuse("task body " + quoted(body.name) + ": no strip table");
    const std::string where =
        "task body " + quoted(body.name) + ", strips " + quoted(strips.begin->name());
    const long values = value_count(strips);
    if (static_cast<long>(strips.begin->count()) < strips.first + values) {
        throw Misuse(where + ": " + std::to_string(strips.strip_count) + " strips take " +
                     std::to_string(strips.first + values) + " values, and it has " +
                     std::to_string(strips.begin->count()));
    }
    for (long i = 0; i < values; ++i) {
        const auto at = static_cast<std::size_t>(strips.first + i);
        const int least = i == 0 ? 0 : (*strips.begin)[at - 1];
        if ((*strips.begin)[at] >= least) continue;
        throw Misuse(where + ": value " + std::to_string(at) + " is " +
                     std::to_string((*strips.begin)[at]) +
                     "; where strips begin is never less than where the one before does");
    }
}

void check_bodies(Work& work) {
    const auto kinds = static_cast<int>(work.kinds().size());
    long items = 0;
    for (const TaskBody* body : work.bodies()) {
        check_kind(*body, kinds);
        for (const Launch& launch : body->launches) {
            check_alive(*body, launch);
            check_strips(*body, launch.segments);
            items += launch.segments.item_count(0, launch.segments.strip_count);
        }
    }
    if (items == 0 && work.tables().empty() && !work.bodies().empty()) {
        throw Misuse("no strip has an item: strip tables are filled in before a runner is made");
    }
}

void check_access(const Task& task, const Launch& launch, const BufferStorage* buffer,
                  bool writes) {
    if (buffer == nullptr) return;
    const bool is_said = std::ranges::any_of(task.accesses, [&](const Access& access) {
        return access.buffer == buffer && (access.writes || !writes);
    });
    if (is_said) return;
    throw Misuse("task body " + quoted(task.body->name) + ": kernel " +
                 quoted(std::string(launch.kernel->name)) + (writes ? " writes " : " reads ") +
                 quoted(buffer->name()) + ", and the task does not say so: ." +
                 (writes ? "updates" : "reads") + "() is missing");
}

/// Each buffer that the task's kernels get has to be among its accesses, or others would not know
/// to wait for it, and devices with memory of their own would not get it.
void check_accesses(const Task& task) {
    for (const Launch& launch : task.body->launches) {
        check_access(task, launch, launch.gate, false);
        for (std::size_t i = 0; i < launch.arguments.size(); ++i) {
            check_access(task, launch, launch.arguments[i].buffer,
                         is_written(launch.kernel->parameters[i]));
        }
    }
}

}  // namespace

void check_work(Work& work, std::size_t devices) {
    if (devices == 0) throw Misuse("a runner needs at least one device");
    if (work.strip_count() < 1) throw Misuse("the work has no strips");
    check_bodies(work);
    const Step step = work.make_step(Partition::whole(work.strip_count()));
    for (const Task& task : step.tasks()) check_accesses(task);
}

KnownBuffers::KnownBuffers(Work& work) {
    std::set<const BufferStorage*> resized;
    for (RowTable* table : work.tables()) {
        for (const BufferStorage* column : table->resized_buffers()) resized.insert(column);
    }
    const auto stays = [&](const BufferStorage* buffer) {
        return buffer != nullptr && !resized.contains(buffer);
    };
    for (const TaskBody* body : work.bodies()) {
        for (const Launch& launch : body->launches) {
            if (stays(launch.segments.begin)) add_strips(*body, launch.segments);
            if (stays(launch.gate)) add_size(*launch.gate);
            for (const Argument& argument : launch.arguments) {
                if (stays(argument.buffer)) add_size(*argument.buffer);
            }
        }
    }
}

void KnownBuffers::add_size(const BufferStorage& buffer) {
    const auto is_it = [&](const auto& known) { return known.first == &buffer; };
    if (std::ranges::any_of(generations_, is_it)) return;
    generations_.emplace_back(&buffer, buffer.generation());
}

void KnownBuffers::add_strips(const TaskBody& body, const Segments& strips) {
    add_size(*strips.begin);
    const auto is_it = [&](const Strips& known) {
        return known.table.begin == strips.begin && known.table.first == strips.first &&
               value_count(known.table) == value_count(strips);
    };
    if (std::ranges::any_of(strips_, is_it)) return;
    strips_.push_back({strips, body.name, values_of(strips)});
}

void KnownBuffers::check() const {
    for (const auto& [buffer, generation] : generations_) {
        if (buffer->generation() == generation) continue;
        throw Misuse("buffer " + quoted(buffer->name()) +
                     " was resized while a runner has it; make the runner anew");
    }
    for (const Strips& known : strips_) {
        if (values_of(known.table) == known.values) continue;
        throw Misuse("task body " + quoted(known.body) + ", strips " +
                     quoted(known.table.begin->name()) +
                     ": where strips begin was changed while a runner plans by it; make the work "
                     "and its runner anew");
    }
}

}  // namespace weft
