#include "tests/runtime/trace/synthetic_run.h"

#include <algorithm>
#include <array>
#include <limits>
#include <random>
#include <string>

namespace weft::synthetic {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kFrameTime = 0.05;
constexpr std::uint32_t kStrips = 16;
constexpr std::uint32_t kItemsPerStrip = 5000;
constexpr std::array<double, 2> kPerItem = {4.0e-9, 5.0e-9};  // device 1 is the slower one
constexpr std::array<double, 2> kFixed = {2.0e-6, 8.0e-6};

constexpr double kLatency = 2.0e-6;

enum Kind : std::uint32_t { kPredict, kSpring, kSpringSeam, kBending, kVelocity };

double predicted(std::uint32_t device, std::uint64_t items) {
    return kFixed[device] + kPerItem[device] * static_cast<double>(items);
}

/// Lists the tasks of one substep; the cut between the devices wanders a little over the frames.
class PlanMaker {
public:
    PlanMaker(const Shape& shape, std::uint32_t number) : cut_(8 + number % 3) {
        both(kPredict, 0);
        for (std::uint32_t i = 0; i < shape.iterations; ++i) {
            both(kSpring, i);
            both(kBending, i);
            meet();
            task(kSpringSeam, i, 0, cut_ - 1, 2, 400);
            meet();
        }
        both(kVelocity, 0);
    }

    std::vector<PlanRecord> plan;
    std::vector<DependencyRecord> dependencies;
    std::uint32_t cut() const { return cut_; }
    double makespan() const { return std::max(free_[0], free_[1]); }

private:
    void both(Kind kind, std::uint32_t iteration) {
        task(kind, iteration, 0, 0, cut_, cut_ * kItemsPerStrip);
        task(kind, iteration, 1, cut_, kStrips - cut_, (kStrips - cut_) * kItemsPerStrip);
    }

    void task(Kind kind, std::uint32_t iteration, std::uint32_t device, std::uint32_t first,
              std::uint32_t count, std::uint64_t items) {
        const double start = free_[device];
        free_[device] += predicted(device, items);
        const auto number = static_cast<std::uint32_t>(plan.size());
        for (std::uint32_t d = 0; d < 2; ++d) {
            if (last_[d] != kNone && (d == device || meeting_[device])) {
                dependencies.push_back({last_[d], number, 0, 12800.0});
            }
        }
        meeting_[device] = false;
        last_[device] = number;
        plan.push_back({number, kind, iteration, first, count, device, device, order_[device]++,
                        items, start, free_[device]});
    }

    /// Both wait for each other.
    void meet() {
        free_[0] = free_[1] = std::max(free_[0], free_[1]) + kLatency;
        meeting_ = {true, true};
    }

    static constexpr std::uint32_t kNone = 0xffffffff;

    std::uint32_t cut_;
    std::array<double, 2> free_{};
    std::array<std::uint32_t, 2> order_{};
    std::array<std::uint32_t, 2> last_{kNone, kNone};  // task of each device
    std::array<bool, 2> meeting_{};                    // its next task waits for the other device
};

/// Runs the plan with times that scatter by a few per cent.
void execute(const Shape& shape, FrameRecord& record, double plan_makespan) {
    std::mt19937 random(record.frame + 1);
    std::normal_distribution<double> scatter(1.03, 0.03);
    double substep_start = record.start + record.plan_time;
    for (std::uint32_t substep = 0; substep < shape.substeps; ++substep) {
        const double stretch = std::max(0.9, scatter(random));
        for (const PlanRecord& task : record.plan) {
            const double start = substep_start + stretch * task.start;
            const double end = substep_start + stretch * task.end;
            record.executions.push_back({substep, task.task, task.device, task.items, start, end});
            record.busy[task.device] += end - start;
            if (shape.transfers && task.kind == kSpringSeam) {
                record.transfers.push_back({substep, task.task, 1, 0, 12800, start - 1e-6, start});
                record.transferred_bytes += 12800;
            }
        }
        substep_start += stretch * plan_makespan;
    }
    record.end = substep_start;
    record.measured_makespan = record.end - record.start - record.plan_time;
    record.execute_time = record.measured_makespan;
}

}  // namespace

RunDescription describe(const Shape& shape) {
    RunDescription run;
    run.scene_name = "synthetic";
    run.scene_path = "/somewhere/synthetic.toml";
    run.scene_text = "[scene]\nname = \"synthetic\"  # with a non-ASCII word: Köper\n";
    run.command = "weft run synthetic.toml --device cpu/1+opencl:0/1";
    run.host = {{"name", "loom"}, {"cpu", "AMD EPYC"}};
    run.versions = {{"weft", "0.1.0"}};
    run.settings = {{"plan", "exact"}, {"substeps", std::to_string(shape.substeps)}};
    run.devices = {{"AMD EPYC", "tbb", "", 1, "host", true},
                   {"pthread-AMD EPYC", "opencl", "PoCL 3.1", 1, "host", true}};
    run.kinds = {"predict", "spring", "spring seam", "bending", "velocity"};
    run.energies = {"spring", "bending"};
    run.warnings = {"thin triangles"};
    run.has_transfers = shape.transfers;
    run.has_contacts = shape.contacts;
    return run;
}

FrameRecord frame(const Shape& shape, std::uint32_t number) {
    const PlanMaker maker(shape, number);
    FrameRecord record;
    record.frame = number;
    record.sim_time = (number + 1) / 60.0;
    record.start = number * kFrameTime;
    record.plan_time = 40e-6;
    record.planned_makespan = shape.substeps * maker.makespan();
    record.lower_bound = 0.93 * record.planned_makespan;
    record.busy = {0.0, 0.0};
    record.plan = maker.plan;
    record.planner = "in-order";
    record.graph = std::make_shared<const GraphRecord>(
        GraphRecord{number % 3, {maker.cut(), kStrips - maker.cut()}, maker.dependencies});
    record.pace = 1.0 + 0.125 * number;
    record.place_time = 1e-6 * number;
    record.check_time = 2e-6 * number;
    record.learn_time = 3e-6 * number;
    record.measure_time = 4e-6 * number;
    record.output_time = 5e-6 * number;
    record.links = {{0, 1, kLatency, kInfinite}, {1, 0, kLatency, kInfinite}};
    record.state_hash = std::string(31, 'a') + static_cast<char>('0' + number % 10);
    execute(shape, record, maker.makespan());
    for (std::uint32_t kind = 0; kind <= kVelocity; ++kind) {
        for (std::uint32_t device = 0; device < 2; ++device) {
            record.costs.push_back({kind, device, kFixed[device], kPerItem[device], number + 1});
        }
    }
    const double fallen = std::min(1.0, 0.05 * number);
    record.gravity_energy = 2.0 * (1.0 - fallen);
    record.kinetic_energy = 1.5 * fallen * (1.0 - fallen);
    record.energies = {0.2 * fallen, 0.01 * fallen};
    if (number % 4 == 3) record.warnings = {"energy from nowhere", "contact: a vertex is lost"};
    record.work = 0.25 * number;
    record.dissipated = 0.125 * number;
    record.gained = 0.0625 * number;
    record.strain_rms = 0.01 * number;
    record.strain_max = 0.1 * number;
    record.substeps = 4 + number;
    record.iterations = 8 + number;
    record.relative_error = 0.03 * number;
    if (shape.contacts) {
        record.contacts = {{1000 + number, 3000 + number, 50 + number, 10 + number, number,
                            number % 2, 20 + number, 1e-3 * number}};
    }
    return record;
}

}  // namespace weft::synthetic
