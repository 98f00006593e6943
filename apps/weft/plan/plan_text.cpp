#include "apps/weft/plan/plan_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace weft {
namespace {

using scheduler::Placement;
using scheduler::Plan;
using scheduler::ProcessorId;
using scheduler::TaskId;

constexpr std::size_t kColumns = 80;
constexpr std::size_t kLabelColumns = 16;

/// A block begins with '|', carries its name if there is room, and is filled with '='.
void draw(std::string& line, const Placement& placement, double scale, std::string name) {
    const auto column = [&](double time) {
        return std::min(static_cast<std::size_t>(time * scale), line.size() - 1);
    };
    const std::size_t begin = column(placement.start);
    const std::size_t end = std::max(begin + 1, column(placement.end));
    line[begin] = '|';
    for (std::size_t i = begin + 1; i < end; ++i) {
        const std::size_t letter = i - begin - 1;
        line[i] = letter < name.size() ? name[letter] : '=';
    }
    if (end < line.size() && line[end] == ' ') line[end] = '|';
}

std::string with_unit(const std::string& word, const TimeUnit& unit) {
    return unit.name.empty() ? word : fmt::format("{} [{}]", word, unit.name);
}

}  // namespace

std::string plan_table(const GraphFile& file, const Plan& plan) {
    std::vector<TaskId> tasks = plan.order;
    std::stable_sort(tasks.begin(), tasks.end(), [&](TaskId a, TaskId b) {
        return plan.placements[a].start < plan.placements[b].start;
    });
    std::size_t task_width = 4, processor_width = 9;
    for (const TaskId t : tasks) task_width = std::max(task_width, file.graph.name(t).size());
    for (const std::string& p : file.processors)
        processor_width = std::max(processor_width, p.size());
    std::string text =
        fmt::format("{:<{}}  {:<{}}  {:>12}  {:>12}\n", "task", task_width, "processor",
                    processor_width, with_unit("start", file.unit), with_unit("end", file.unit));
    for (const TaskId t : tasks) {
        const Placement& own = plan.placements[t];
        text += fmt::format("{:<{}}  {:<{}}  {:>12.8g}  {:>12.8g}\n", file.graph.name(t),
                            task_width, file.processors[own.processor], processor_width,
                            file.unit.factor * own.start, file.unit.factor * own.end);
    }
    return text;
}

std::string plan_gantt(const GraphFile& file, const Plan& plan) {
    std::size_t label_width = 0;
    for (const std::string& name : file.processors)
        label_width = std::max(label_width, name.size());
    label_width = std::min(label_width, kLabelColumns);
    const double scale =
        plan.makespan > 0.0 ? static_cast<double>(kColumns - 1) / plan.makespan : 0.0;
    std::string text;
    for (ProcessorId p = 0; p < file.processors.size(); ++p) {
        std::string line(kColumns, ' ');
        for (const TaskId t : plan.tasks_on(p)) {
            draw(line, plan.placements[t], scale, std::string(file.graph.name(t)));
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += fmt::format("{:<{}} {}\n", file.processors[p].substr(0, label_width), label_width,
                            line);
    }
    const std::string end = fmt::format("{:.6g}{}{}", file.unit.factor * plan.makespan,
                                        file.unit.name.empty() ? "" : " ", file.unit.name);
    text += fmt::format("{:<{}} 0{:>{}}\n", "", label_width, end, kColumns - 1);
    return text;
}

}  // namespace weft
