#include "tests/runtime/random_tasks.h"

#include "kernels/motion.h"
#include "kernels/xpbd/springs.h"
#include "tests/kernels/run_on_host.h"

namespace weft::test {

namespace {

constexpr int kBegin[] = {0, 5, 6, 20, 20, 37, 50, 51, 64};  // one strip without vertices
constexpr int kVertices = 64;
constexpr int kColours = 2;
constexpr int kSpringTable = 3;  // where the springs' segments start in their buffer

int spring_count() {
    int count = 0;
    for (int s = 0; s + 1 < static_cast<int>(std::size(kBegin)); ++s) {
        count += std::max(0, kBegin[s + 1] - kBegin[s] - 1);
    }
    return count;
}

}  // namespace

struct RandomTasks::Body {
    TaskBody body;
    std::vector<int> read, updated;  ///< buffers of points
    bool has_multipliers = false;
    bool is_gated = false;
};

RandomTasks::RandomTasks()
    : strip_begin_("strips", kStrips + 1),
      spring_begin_("springs", kSpringTable + kStrips * kColours + 1),
      strips_{&strip_begin_, 0, 1, kStrips},
      springs_{&spring_begin_, kSpringTable, kColours, kStrips},
      gravity_("gravity", kInstances + 1),
      ends_("ends", 2 * static_cast<std::size_t>(spring_count())),
      material_("material", ends_.count()),
      multipliers_("multipliers", ends_.count() / 2),
      gate_("gate", kStrips) {
    std::copy(std::begin(kBegin), std::end(kBegin), strip_begin_.data());
    for (int i = 0; i < kPoints; ++i) {
        points_.push_back(
            std::make_unique<Buffer<float4>>("points" + std::to_string(i), kVertices));
    }
    // A chain through each strip's vertices, in two colours.
    std::size_t next = 0;
    for (int strip = 0; strip < kStrips; ++strip) {
        for (int colour = 0; colour < kColours; ++colour) {
            spring_begin_[static_cast<std::size_t>(kSpringTable + strip * kColours + colour)] =
                static_cast<int>(next);
            for (int v = kBegin[strip] + colour; v + 1 < kBegin[strip + 1]; v += 2) {
                ends_[next] = v;
                ends_[next + multipliers_.count()] = v + 1;
                ++next;
            }
        }
    }
    spring_begin_[spring_begin_.count() - 1] = static_cast<int>(next);
    add_bodies();
}

RandomTasks::~RandomTasks() = default;

void RandomTasks::add_bodies() {
    constexpr float kH = 0.5f;
    constexpr float kInverseH = 0.5f;  // not 1 / h: values must stay finite in any order
    const auto body = [&]() -> Body& { return *bodies_.emplace_back(std::make_unique<Body>()); };
    for (const auto& [x, y, z] : {std::array{0, 1, 2}, {2, 3, 0}, {3, 0, 1}}) {
        auto& a = *points_[static_cast<std::size_t>(x)];
        auto& b = *points_[static_cast<std::size_t>(y)];
        auto& c = *points_[static_cast<std::size_t>(z)];
        Body& predict = body();
        predict.updated = {x, y};
        predict.read = {z};
        predict.body.launches = {
            launch(kernels::predict, strips_, a, b, c, gravity_, kH, kInstance)};
        Body& update = body();
        update.updated = {z};
        update.read = {x, y};
        update.body.launches = {launch(kernels::update_velocities, strips_, a, b, c, gravity_, kH,
                                       kInverseH, kInstance)};
    }
    Body& springs = body();
    springs.updated = {0};
    springs.has_multipliers = true;
    springs.body.launches = {launch(kernels::project_springs, springs_, *points_[0], ends_,
                                    material_, multipliers_, static_cast<int>(multipliers_.count()),
                                    100.0f, 0)};
    // Two launches that take turns: what the second does to one colour, the first's next one sees.
    Body& turns = body();
    turns.updated = {0};
    turns.has_multipliers = true;
    for (const int fresh : {0, 1}) {
        turns.body.launches.push_back(launch(kernels::project_springs, springs_, *points_[0], ends_,
                                             material_, multipliers_,
                                             static_cast<int>(multipliers_.count()), 10.0f, fresh));
    }
    turns.body.taking_turns = 2;
    // Three, one of which has nothing to do in some strips.
    Body& gated = body();
    gated.updated = {0, 1};
    gated.read = {2};
    gated.has_multipliers = gated.is_gated = true;
    gated.body = {"", 0, {turns.body.launches[0], only_where(gate_, turns.body.launches[1])}, 2};
    gated.body.launches.push_back(
        only_where(gate_, launch(kernels::predict, strips_, *points_[0], *points_[1], *points_[2],
                                 gravity_, kH, kInstance)));
    // Gravity by the task's iteration instead of the instance, and a launch behind the turns.
    Body& falls = body();
    falls.updated = {0, 1};
    falls.read = {2};
    falls.has_multipliers = true;
    falls.body = {"", 0, {turns.body.launches[0], turns.body.launches[1]}, 2};
    falls.body.launches.push_back(launch(kernels::predict, strips_, *points_[0], *points_[1],
                                         *points_[2], gravity_, kH, kIteration));
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        bodies_[b]->body.name = "body " + std::to_string(b);
        bodies_[b]->body.kind = static_cast<int>(b);
    }
}

void RandomTasks::fill(Random& random) {
    for (const auto& buffer : points_) {
        for (float4& point : buffer->span()) {
            point = random.point(1.0f);
            point.w = random.real(0.1f, 1.0f);
        }
    }
    for (float4& g : gravity_.span()) g = random.point(1.0f);
    for (float& value : material_.span()) value = random.real(0.1f, 1.0f);
    for (float& value : multipliers_.span()) value = random.real(-0.1f, 0.1f);
    for (int& flag : gate_.span()) flag = random.integer(0, 2);
}

Step RandomTasks::make_step(Random& random, int task_count) {
    Step step;
    for (int t = 0; t < task_count; ++t) {
        const Body& body = *bodies_[static_cast<std::size_t>(
            random.integer(0, static_cast<int>(bodies_.size()) - 1))];
        const int first = random.integer(0, kStrips - 1);
        const int end = random.integer(first + 1, kStrips);
        auto task = step.add(body.body, random.integer(0, kInstances), {first, end});
        for (const int p : body.updated) {
            task.updates(*points_[static_cast<std::size_t>(p)], kBegin[first], kBegin[end]);
        }
        for (const int p : body.read) {
            task.reads(*points_[static_cast<std::size_t>(p)], kBegin[first], kBegin[end]);
        }
        if (body.has_multipliers) task.updates(multipliers_, body.body.launches[0].segments);
        if (body.is_gated) task.reads(gate_, first, end);
    }
    step.seal();
    return step;
}

std::vector<const TaskBody*> RandomTasks::bodies() const {
    std::vector<const TaskBody*> list;
    for (const auto& body : bodies_) list.push_back(&body->body);
    return list;
}

std::vector<BufferStorage*> RandomTasks::buffers() {
    std::vector<BufferStorage*> list{&gravity_, &material_, &multipliers_, &gate_};
    for (const auto& buffer : points_) list.push_back(buffer.get());
    return list;
}

std::vector<float> RandomTasks::state() {
    std::vector<float> all;
    for (BufferStorage* buffer : buffers()) {
        const auto* values = static_cast<const float*>(buffer->host());
        all.insert(all.end(), values, values + buffer->bytes() / sizeof(float));
    }
    return all;
}

void RandomTasks::run_serially(const Task& task, int strip, int instance) {
    const auto& launches = task.body->launches;
    const auto run = [&](const Launch& launch, int colour) {
        const Segments& s = launch.segments;
        if (is_closed(launch.gate, strip)) return;
        run_on_host(launch, launch.kernel->scalar, s.item(strip, colour), s.item(strip, colour + 1),
                    instance, task.iteration);
    };
    const auto turns = static_cast<std::size_t>(task.body->taking_turns);
    for (int colour = 0; turns > 0 && colour < kColours; ++colour) {
        for (std::size_t l = 0; l < turns; ++l) run(launches[l], colour);
    }
    for (std::size_t l = turns; l < launches.size(); ++l) {
        for (int c = 0; c < launches[l].segments.colour_count; ++c) run(launches[l], c);
    }
}

void RandomTasks::run_serially(const Step& step) {
    for (int instance = 0; instance < kInstances; ++instance) {
        for (const Task& task : step.tasks()) {
            for (int strip = task.first_strip; strip < task.end_strip; ++strip) {
                run_serially(task, strip, instance);
            }
        }
    }
}

scheduler::Plan random_plan(const Step& step, int device_count, Random& random) {
    const std::size_t count = step.tasks().size();
    scheduler::Plan plan;
    plan.placements.resize(count);
    std::vector<bool> is_placed(count, false);
    const auto is_ready = [&](std::size_t task) {
        if (is_placed[task]) return false;
        for (const Dependency& d : step.dependencies()) {
            if (d.to == static_cast<int>(task) && !is_placed[static_cast<std::size_t>(d.from)]) {
                return false;
            }
        }
        return true;
    };
    for (std::size_t next = 0; next < count; ++next) {
        std::vector<std::size_t> ready;
        for (std::size_t task = 0; task < count; ++task) {
            if (is_ready(task)) ready.push_back(task);
        }
        const std::size_t task =
            ready[static_cast<std::size_t>(random.integer(0, static_cast<int>(ready.size()) - 1))];
        is_placed[task] = true;
        const auto start = static_cast<double>(next);
        plan.placements[task] = {
            start, start + 1.0,
            static_cast<scheduler::ProcessorId>(random.integer(0, device_count - 1))};
    }
    plan.order_by_start(static_cast<scheduler::ProcessorId>(device_count));
    return plan;
}

}  // namespace weft::test
