#include "apps/weft/trace/perfetto.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "apps/weft/trace/recorded_frames.h"
#include "runtime/error.h"
#include "runtime/io/json_text.h"
#include "runtime/trace/recorded_graph.h"

namespace weft {

namespace {

using nlohmann::ordered_json;

// The format is Google's "Trace Event Format". `ph` is the type of an event: M metadata, X a slice,
// C a counter, s and f the ends of an arrow. Times are in microseconds.
constexpr int kProcess = 1;
constexpr int kFrameTrack = 0;
constexpr int kFirstDeviceTrack = 1;

int device_track(std::uint32_t device) { return kFirstDeviceTrack + static_cast<int>(device); }

std::int64_t nanoseconds(double seconds) { return std::llround(1e9 * seconds); }

double microseconds(std::int64_t nanoseconds) { return static_cast<double>(nanoseconds) / 1e3; }

ordered_json event(const char* type, const std::string& name, int track) {
    return {{"ph", type}, {"name", name}, {"pid", kProcess}, {"tid", track}};
}

}  // namespace

/// Gathers the events of one frame.
class PerfettoText::Frame {
public:
    Frame(PerfettoText& owner, const FrameRecord& frame)
        : owner_(owner),
          frame_(frame),
          tasks_(tasks_in_order(owner.run_, frame)),
          substeps_(substeps_of(frame)),
          slices_(tasks_.size() * substeps_) {}

    std::string text() {
        add_frame();
        add_executions();
        add_transfers();
        if (frame_.graph) add_dependencies();
        std::stable_sort(events_.begin(), events_.end(), [](const Event& a, const Event& b) {
            return std::pair(a.time, a.order) < std::pair(b.time, b.order);
        });
        for (const Event& e : events_) names_ += e.text;
        return std::move(names_);
    }

private:
    // Among events of one time: a slice goes before those inside it, arrows leave before they
    // arrive.
    static constexpr std::int64_t kAfterSlices = 1;

    void add_event(std::int64_t time, std::int64_t order, const ordered_json& json) {
        events_.push_back({time, order, {}});
        owner_.add(events_.back().text, json);
    }

    void add_slice(const Slice& slice, const std::string& name, const char* category,
                   ordered_json arguments) {
        ordered_json json = event("X", name, slice.track);
        json["cat"] = category;
        json["ts"] = microseconds(slice.start);
        json["dur"] = microseconds(slice.end - slice.start);
        json["args"] = std::move(arguments);
        add_event(slice.start, slice.start - slice.end, json);
    }

    void add_frame() {
        const Slice whole{nanoseconds(frame_.start), nanoseconds(frame_.end), kFrameTrack};
        add_slice(whole, fmt::format("frame {}", frame_.frame), "frame",
                  {{"frame", frame_.frame},
                   {"planned_ms", 1e3 * frame_.planned_makespan},
                   {"measured_ms", 1e3 * frame_.measured_makespan},
                   {"lower_bound_ms", 1e3 * frame_.lower_bound},
                   {"transferred_bytes", frame_.transferred_bytes},
                   {"state_hash", frame_.state_hash}});
        add_parts(whole);
        ordered_json counter = event("C", "makespan", kFrameTrack);
        counter["ts"] = microseconds(whole.start);
        counter["args"] = {{"planned_ms", 1e3 * frame_.planned_makespan},
                           {"measured_ms", 1e3 * frame_.measured_makespan}};
        add_event(whole.start, kAfterSlices, counter);
    }

    void add_parts(const Slice& whole) {
        double time = frame_.start;
        std::int64_t begin = whole.start;
        for (const FramePart& part : kFrameParts) {
            time += frame_.*part.time;
            const std::int64_t end = std::min(nanoseconds(time), whole.end);
            if (end > begin)
                add_slice({begin, end, kFrameTrack}, part.name, "part", {{"frame", frame_.frame}});
            begin = end;
        }
    }

    void add_executions() {
        std::vector<ExecutionRecord> executions = frame_.executions;
        std::stable_sort(executions.begin(), executions.end(),
                         [](const auto& a, const auto& b) { return a.start < b.start; });
        for (const ExecutionRecord& e : executions) {
            if (e.task >= tasks_.size() || e.device >= owner_.device_free_.size()) {
                throw UserError(fmt::format("frame {}: its executions are damaged", frame_.frame));
            }
            // A device does one task at a time; what is left of that after rounding.
            std::int64_t& free = owner_.device_free_[e.device];
            const std::int64_t start = std::max(nanoseconds(e.start), free);
            free = std::max(nanoseconds(e.end), start + 1);
            const Slice slice{start, free, device_track(e.device)};
            slices_[at(e.substep, e.task)] = slice;
            const PlanRecord& task = tasks_[e.task];
            add_slice(slice, owner_.run_.kinds[task.kind], "task",
                      {{"frame", frame_.frame},
                       {"substep", e.substep},
                       {"task", e.task},
                       {"iteration", task.iteration},
                       {"first_strip", task.first_strip},
                       {"strip_count", task.strip_count},
                       {"items", e.items},
                       {"planned_start_us", 1e6 * task.start},
                       {"planned_us", 1e6 * (task.end - task.start)}});
        }
    }

    void add_transfers() {
        for (const TransferRecord& t : frame_.transfers) {
            if (t.task >= tasks_.size() || t.substep >= substeps_) continue;
            Slice slice{nanoseconds(t.start), nanoseconds(t.end), -1};
            slice.end = std::max(slice.end, slice.start + 1);
            slice.track = owner_.copy_track(names_, slice.start, slice.end);
            add_slice(slice, fmt::format("copy {} to {}", t.from, t.to), "transfer",
                      {{"frame", frame_.frame},
                       {"substep", t.substep},
                       {"task", t.task},
                       {"from", t.from},
                       {"to", t.to},
                       {"bytes", t.bytes}});
            add_arrow(slice, slices_[at(t.substep, t.task)], "transfer");
        }
    }

    void add_dependencies() {
        for (const DependencyRecord& d : frame_.graph->dependencies) {
            if (d.from >= tasks_.size() || d.to >= tasks_.size()) continue;
            for (std::uint32_t substep = d.carried; substep < substeps_; ++substep) {
                const Slice& from = slices_[at(substep - d.carried, d.from)];
                const Slice& to = slices_[at(substep, d.to)];
                if (from.track != to.track) add_arrow(from, to, "dependency");
            }
        }
    }

    /// From the end of one slice to the start of another. Clocks of two devices agree to a
    /// microsecond or two only, so it may have to leave a little earlier; or not at all.
    void add_arrow(const Slice& from, const Slice& to, const char* name) {
        const std::int64_t leaves = std::min(from.end - 1, to.start);
        if (from.track < 0 || to.track < 0 || leaves < from.start) return;
        const std::uint64_t id = owner_.next_flow_++;
        const auto add_end = [&](const char* type, int track, std::int64_t time,
                                 std::int64_t order) {
            ordered_json json = event(type, name, track);
            json["cat"] = name;
            json["id"] = id;
            json["ts"] = microseconds(time);
            if (*type == 'f') json["bp"] = "e";  // it arrives at the slice around it
            add_event(time, order, json);
        };
        add_end("s", from.track, leaves, kAfterSlices);
        add_end("f", to.track, to.start, kAfterSlices + 1);
    }

    std::size_t at(std::uint32_t substep, std::uint32_t task) const {
        return std::size_t{substep} * tasks_.size() + task;
    }

    PerfettoText& owner_;
    const FrameRecord& frame_;
    std::vector<PlanRecord> tasks_;
    std::uint32_t substeps_;
    std::vector<Slice> slices_;  ///< [substep][task]
    std::vector<Event> events_;
    std::string names_;  ///< of tracks that are new
};

PerfettoText::PerfettoText(const RunDescription& run)
    : run_(run), device_free_(run.devices.size(), std::numeric_limits<std::int64_t>::min()) {}

void PerfettoText::add(std::string& text, const ordered_json& event) {
    if (!std::exchange(first_, false)) text += ",\n";
    text += json_text(event, -1);
}

void PerfettoText::name_track(std::string& text, int track, const std::string& name) {
    ordered_json json = event("M", "thread_name", track);
    json["args"] = {{"name", name}};
    add(text, json);
    json["name"] = "thread_sort_index";
    json["args"] = {{"sort_index", track}};
    add(text, json);
}

/// The first track on which nothing happens then.
int PerfettoText::copy_track(std::string& text, std::int64_t start, std::int64_t end) {
    const int first = device_track(static_cast<std::uint32_t>(run_.devices.size()));
    const auto free = std::find_if(copies_free_.begin(), copies_free_.end(),
                                   [&](std::int64_t time) { return time <= start; });
    const int track = first + static_cast<int>(free - copies_free_.begin());
    if (free != copies_free_.end()) {
        *free = end;
    } else {
        copies_free_.push_back(end);
        name_track(text, track, "copies");
    }
    return track;
}

std::string PerfettoText::head() {
    std::string text = "{\"displayTimeUnit\": \"ms\",\n\"otherData\": ";
    text += json_text(ordered_json{{"scene", run_.scene_name}, {"command", run_.command}}, -1);
    text += ",\n\"traceEvents\": [\n";
    ordered_json process = event("M", "process_name", kFrameTrack);
    process["args"] = {{"name", "weft " + run_.scene_name}};
    add(text, process);
    name_track(text, kFrameTrack, "frames");
    for (std::uint32_t d = 0; d < run_.devices.size(); ++d) {
        name_track(text, device_track(d), short_device_name(run_, d) + " " + run_.devices[d].name);
    }
    return text;
}

std::string PerfettoText::frame(const FrameRecord& frame) { return Frame(*this, frame).text(); }

std::string PerfettoText::tail() const { return "\n]}\n"; }

}  // namespace weft
