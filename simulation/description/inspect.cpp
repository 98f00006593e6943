#include "simulation/description/inspect.h"

#include <algorithm>
#include <functional>
#include <set>

#include "runtime/io/hdf5/handle.h"
#include "runtime/trace/frame_rows.h"
#include "runtime/trace/tables.h"
#include "simulation/families/builder.h"
#include "simulation/scene/obstacle_shapes.h"
#include "simulation/state/diagnostics.h"

namespace weft {

namespace {

using kernels::KernelInfo;

// ---- what is there: all of it is read off the solver's own bodies and steps ----

std::vector<Inspection::Task> find_tasks(const Model& model, Solver& solver) {
    std::vector<Inspection::Task> tasks;
    for (const std::string& kind : solver.kinds()) tasks.push_back({kind, 0, {}});
    const Step step = solver.make_step(Partition::whole(model.strips.count()));
    for (const Task& task : step.tasks()) {
        Inspection::Task& entry = tasks[static_cast<std::size_t>(task.body->kind)];
        ++entry.per_substep;
        if (!entry.launches.empty()) continue;  // bodies of a kind differ in arguments only
        for (const Launch& launch : task.body->launches) {
            const Segments& segments = launch.segments;
            entry.launches.push_back({std::string(launch.kernel->name),
                                      segments.item_count(0, segments.strip_count),
                                      segments.colour_count});
        }
    }
    std::erase_if(tasks, [](const Inspection::Task& task) { return task.per_substep == 0; });
    return tasks;
}

struct ByName {
    bool operator()(const KernelInfo* a, const KernelInfo* b) const { return a->name < b->name; }
};
using KernelSet = std::set<const KernelInfo*, ByName>;

KernelSet used_kernels(const Solver& solver) {
    KernelSet used;
    for (const TaskBody* body : solver.bodies()) {
        for (const Launch& launch : body->launches) used.insert(launch.kernel);
    }
    return used;
}

std::vector<Inspection::Buffer> find_buffers(const Solver& solver) {
    std::vector<const BufferStorage*> buffers;
    const auto add = [&](const BufferStorage* buffer) {
        if (buffer == nullptr || std::count(buffers.begin(), buffers.end(), buffer) > 0) return;
        buffers.push_back(buffer);
    };
    for (const TaskBody* body : solver.bodies()) {
        for (const Launch& launch : body->launches) {
            for (const Argument& argument : launch.arguments) add(argument.buffer);
            add(launch.segments.begin);
            add(launch.gate);
        }
    }
    std::vector<Inspection::Buffer> list;
    for (const BufferStorage* buffer : buffers) list.push_back({buffer->name(), buffer->bytes()});
    return list;
}

std::vector<std::string> columns_of(const trace::RowType& type) {
    std::vector<std::string> names;
    const int count = H5Tget_nmembers(type.file());
    for (int i = 0; i < count; ++i) {
        char* name = H5Tget_member_name(type.file(), static_cast<unsigned>(i));
        names.emplace_back(name);
        H5free_memory(name);
    }
    return names;
}

/// As TraceWriter makes them for one device.
std::vector<Inspection::Dataset> find_datasets(const Model& model) {
    const hdf5::Session session;
    return {{"run/scene", {}},
            {"run/kinds", {}},
            {"run/energies", {}},
            {"run/warnings", {}},
            {"run/devices", {}},
            {"frames", columns_of(trace::FrameRows::of_frames(1).type())},
            {"plan", columns_of(trace::plan_row_type())},
            {"divisions", columns_of(trace::division_row_type())},
            {"dependencies", columns_of(trace::dependency_row_type())},
            {"executions", columns_of(trace::execution_row_type())},
            {"costs", columns_of(trace::cost_row_type())},
            {"warnings", columns_of(trace::warning_row_type())},
            {"energies", columns_of(trace::FrameRows::of_energies(energy_names(model)).type())}};
}

// ---- what is not there ----

/// Collects what was left out; each unused kernel goes to the first reason that claims it.
class LeftOutList {
public:
    explicit LeftOutList(const KernelSet& used) {
        for (const KernelInfo* kernel : kernels::all_kernels()) {
            if (used.count(kernel) == 0) unused_.push_back(kernel);
        }
    }

    using Claims = std::function<bool(const KernelInfo&)>;
    void add_with(const std::string& what, const std::string& why, const Claims& claims) {
        Inspection::LeftOut entry{what, why, {}};
        std::erase_if(unused_, [&](const KernelInfo* kernel) {
            if (!claims(*kernel)) return false;
            entry.kernels.emplace_back(kernel->name);
            return true;
        });
        list_.push_back(std::move(entry));
    }
    void add(const std::string& what, const std::string& why, const std::string& kernel = "") {
        add_with(what, why, [&](const KernelInfo& info) { return info.name == kernel; });
    }

    std::vector<Inspection::LeftOut> take(const std::string& why_the_rest) {
        if (!unused_.empty())
            add_with("other kernels", why_the_rest, [](const KernelInfo&) { return true; });
        return std::move(list_);
    }

private:
    std::vector<const KernelInfo*> unused_;
    std::vector<Inspection::LeftOut> list_;
};

template <class Range, class Test>
bool any_of(const Range& range, Test test) {
    return std::any_of(range.begin(), range.end(), test);
}

/// A family's kernels stand in files of its name: kernels/<method>/<family>.h
bool is_of(const KernelInfo& kernel, const std::string& family) {
    return kernel.file.ends_with("/" + family + ".h");
}

void add_elements(LeftOutList& list, const Model& model) {
    for (const auto& builder : make_family_builders()) {
        const std::string& family = builder->names().name;
        const bool exists =
            any_of(model.families, [&](const auto& f) { return f->names().name == family; });
        for (const Absence& absence : builder->absences(model.scene, exists)) {
            list.add_with(absence.what, absence.why, [&](const KernelInfo& kernel) {
                return absence.has_kernels && is_of(kernel, family);
            });
        }
    }
}

void add_obstacles(LeftOutList& list, const Model& model) {
    const std::string push = "push_out_of_", planes = "find_obstacle_planes";
    if (!model.obstacles) {
        list.add_with("obstacles", "the scene has no [[obstacle]]", [&](const KernelInfo& kernel) {
            return kernel.name.starts_with(push) || kernel.name == planes;
        });
        list.add("friction", "the scene has no [[obstacle]]");
        return;
    }
    if (!model.obstacles->have_friction()) {
        list.add("friction", "no obstacle has friction above 0");
    }
    if (model.obstacles->narrow() == nullptr) {
        list.add("narrow obstacles", "triangles have room for none", planes);
    }
    for (const ObstacleShape& shape : obstacle_shapes()) {
        const auto is_it = [&](const Obstacle& o) { return o.shape == shape.name; };
        if (any_of(model.scene.obstacles, is_it)) continue;
        list.add("shape " + shape.name, "no obstacle has this shape", push + shape.name);
    }
}

void add_pins(LeftOutList& list, const Model& model) {
    const auto has_pins = [](const auto& body) { return !body.pins.empty(); };
    if (!any_of(model.scene.cloths, has_pins) && !any_of(model.scene.solids, has_pins)) {
        list.add("pins", "nothing has pins");
    }
    if (!model.moving_pins) list.add("moving pins", "no pins have a motion", "move_pins");
    const auto has_frames = [](const MeshObstacle& obstacle) { return !obstacle.frames.empty(); };
    if (!any_of(model.scene.mesh_obstacles, has_frames)) {
        list.add("frames of obstacles", "no obstacle has motion.frames", "move_between");
    }
}

void add_contact(LeftOutList& list, const Model& model) {
    if (model.scene.contact) return;
    list.add_with("contact", "the scene has no [contact]", [](const KernelInfo& kernel) {
        return kernel.file.find("/contact/") != std::string::npos ||
               kernel.file.ends_with("/contacts.h");
    });
}

void add_damping(LeftOutList& list, const Model& model) {
    if (model.damped) {
        list.add("velocities without damping", "something has damping", "update_velocities");
    } else {
        list.add("damping", "nothing has damping above 0", "update_damped_velocities");
    }
}

std::vector<Inspection::LeftOut> find_left_out(const Model& model, const KernelSet& used) {
    LeftOutList list(used);
    add_elements(list, model);
    add_obstacles(list, model);
    add_pins(list, model);
    add_contact(list, model);
    add_damping(list, model);
    if (model.strips.count() < 2) {
        list.add("seams", "the mesh is too small or too short for a second strip");
    }
    list.add("transfers (dataset)",
             "only a mixture of devices with memories of their own has them");
    return list.take("the scene's solver does not use them");
}

}  // namespace

Inspection inspect(const Model& model, Solver& solver) {
    Inspection result;
    result.origin = model.origin;
    result.vertices = model.vertex_count();
    result.triangles = static_cast<int>(model.triangles.size());
    result.strips = model.strips.count();
    result.tasks = find_tasks(model, solver);
    const KernelSet used = used_kernels(solver);
    for (const KernelInfo* kernel : used) {
        result.kernels.push_back({std::string(kernel->name), std::string(kernel->file)});
    }
    result.buffers = find_buffers(solver);
    result.datasets = find_datasets(model);
    result.left_out = find_left_out(model, used);
    return result;
}

}  // namespace weft
