#include "runtime/tbb/cpu_device.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_scheduler_observer.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "runtime/clock.h"
#include "runtime/cores.h"
#include "runtime/error.h"
#include "scheduler/assert.h"

namespace weft {

namespace {

/// A pack that is half empty takes longer than a full one of half as many lanes.
constexpr int kNarrow = 8;

/// A launch with its arguments as the range function wants them.
struct BoundLaunch {
    kernels::RangeFunction function;
    kernels::RangeFunction narrow;  ///< for ranges of up to kNarrow items
    Segments segments;
    const Buffer<int>* gate;
    std::vector<Argument> values;
    std::vector<void*> pointers;         ///< storage of pointer parameters
    std::vector<const void*> arguments;  ///< to the parameters' values
    std::vector<std::size_t> filled_in;  ///< parameters that are known when a task runs

    BoundLaunch(const Launch& launch, int lanes)
        : function(launch.kernel->form(lanes)),
          narrow(launch.kernel->form(std::min(lanes, kNarrow))),
          segments(launch.segments),
          gate(launch.gate),
          values(launch.arguments),
          pointers(values.size(), nullptr) {
        check_variant(launch, lanes);
        find_buffers();
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (values[i].buffer != nullptr) {
                arguments.push_back(&pointers[i]);
            } else if (launch.kernel->parameters[i] == kernels::Parameter::kFloat) {
                arguments.push_back(&values[i].real);
            } else {
                arguments.push_back(&values[i].integer);
                if (values[i].run_value != RunValue::kNone) filled_in.push_back(i);
            }
        }
    }
    BoundLaunch(BoundLaunch&&) = default;  // vectors keep their storage, so the pointers stay valid

    void find_buffers() {
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (values[i].buffer != nullptr) pointers[i] = values[i].buffer->host();
        }
    }

    bool is_bound_to_present_buffers() const {
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (values[i].buffer != nullptr && pointers[i] != values[i].buffer->host())
                return false;
        }
        return true;
    }

    void fill_in(int instance, int iteration) {
        for (const std::size_t i : filled_in) {
            values[i].integer = values[i].run_value == RunValue::kOfInstance ? instance : iteration;
        }
    }

    void run(int strip, int colour) const {
        if (is_closed(gate, strip)) return;
        const int begin = segments.item(strip, colour);
        const int end = segments.item(strip, colour + 1);
        WEFT_ASSERT(0 <= begin && begin <= end);
        if (begin < end) (end - begin > kNarrow ? function : narrow)(begin, end, arguments.data());
    }
};

struct BoundBody {
    const TaskBody* body;
    std::vector<BoundLaunch> launches;

    void run(int strip) const {
        const auto turns = static_cast<std::size_t>(body->taking_turns);
        for (int colour = 0; turns > 0 && colour < launches[0].segments.colour_count; ++colour) {
            for (std::size_t l = 0; l < turns; ++l) launches[l].run(strip, colour);
        }
        for (std::size_t l = turns; l < launches.size(); ++l) {
            for (int colour = 0; colour < launches[l].segments.colour_count; ++colour) {
                launches[l].run(strip, colour);
            }
        }
    }
};

class CpuCompletion final : public Completion {
public:
    void wait() override {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return done_; });
    }

    void when_done(std::function<void()> callback) override {
        {
            const std::lock_guard lock(mutex_);
            if (!done_) {
                callbacks_.push_back(std::move(callback));
                return;
            }
        }
        callback();
    }

    void set_done() {
        std::vector<std::function<void()>> callbacks;
        {
            const std::lock_guard lock(mutex_);
            done_ = true;
            callbacks.swap(callbacks_);
        }
        changed_.notify_all();
        for (const auto& callback : callbacks) callback();
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    bool done_ = false;
    std::vector<std::function<void()>> callbacks_;
};

struct Job {
    BoundBody* body = nullptr;
    const Task* task = nullptr;
    int number = 0;
    int instance = 0;
    std::vector<Completion*> waits;
    CpuCompletion completion;
};

/// Keeps threads on an arena's cores while they are in it. TBB's workers go from arena to arena.
class PinObserver final : public tbb::task_scheduler_observer {
public:
    PinObserver(tbb::task_arena& arena, const std::vector<int>& cores)
        : tbb::task_scheduler_observer(arena), cores_(cores), all_(usable_cores()) {
        if (!cores_.empty()) observe(true);
    }
    ~PinObserver() override { observe(false); }
    void on_scheduler_entry(bool) override { pin_thread(cores_); }
    void on_scheduler_exit(bool is_worker) override {
        if (is_worker) pin_thread(all_);
    }

private:
    std::vector<int> cores_;
    std::vector<int> all_;  ///< that the thread which makes the arena may use
};

/// A thread of its own runs the stream's jobs in order, inside the arena.
class CpuStream final : public DeviceStream {
public:
    CpuStream(int threads, const std::vector<int>& cores, int lanes,
              std::span<const TaskBody* const> bodies)
        : arena_(threads), observer_(arena_, cores), threads_(threads), cores_(cores) {
        for (const TaskBody* body : bodies) {
            BoundBody bound{body, {}};
            for (const Launch& launch : body->launches) bound.launches.emplace_back(launch, lanes);
            bodies_.push_back(std::move(bound));
        }
        worker_ = std::thread([this] { work(); });  // Apple's libc++ lacks std::jthread
    }

    /// Whoever still waits for jobs that will not run (a device failed in mid-submission) must not
    /// wait for ever.
    ~CpuStream() override {
        {
            const std::lock_guard lock(mutex_);
            stopping_ = true;
        }
        changed_.notify_all();
        worker_.join();
        for (; finished_ < jobs_.size(); ++finished_) jobs_[finished_].completion.set_done();
    }

    void begin(double epoch) override {
        const std::lock_guard lock(mutex_);
        WEFT_ASSERT(finished_ == jobs_.size());
        jobs_.clear();
        times_.clear();
        released_ = 0;
        finished_ = 0;
        epoch_ = epoch;
    }

    void rebind() override {
        for (BoundBody& bound : bodies_) {
            for (BoundLaunch& launch : bound.launches) launch.find_buffers();
        }
    }

    Completion* submit(const Submission& s) override {
        BoundBody& body = find(s.task->body);
        const std::lock_guard lock(mutex_);  // the worker reads jobs_ while it grows
        Job& job = jobs_.emplace_back();
        job.body = &body;
        WEFT_ASSERT(
            std::ranges::all_of(job.body->launches, &BoundLaunch::is_bound_to_present_buffers));
        job.task = s.task;
        job.number = s.number;
        job.instance = s.instance;
        job.waits.assign(s.waits.begin(), s.waits.end());
        return &job.completion;
    }

    /// Jobs wait for this: a worker that starts at once takes its core from the thread that
    /// submits, and the other devices get their first task a millisecond late.
    void flush() override {
        {
            const std::lock_guard lock(mutex_);
            released_ = jobs_.size();
        }
        changed_.notify_one();
    }

    void finish() override {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return finished_ == jobs_.size(); });
        if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    }

    void times(std::vector<TaskTime>& tasks, std::vector<TimeSpan>&) override {
        tasks.insert(tasks.end(), times_.begin(), times_.end());
    }

    // This device works in the host's memory: there is nothing to copy.
    Completion* to_device(BufferStorage&, ElementSpan, std::span<Completion* const>) override {
        return nullptr;
    }
    Completion* to_host(BufferStorage&, ElementSpan, std::span<Completion* const>) override {
        return nullptr;
    }

private:
    BoundBody& find(const TaskBody* body) {
        for (BoundBody& bound : bodies_) {
            if (bound.body == body) return bound;
        }
        throw Misuse("task body '" + body->name + "' is not part of this stream");
    }

    void work() {
        pin_thread(cores_);
        std::unique_lock lock(mutex_);
        while (true) {
            changed_.wait(lock, [this] { return stopping_ || finished_ < released_; });
            if (stopping_) return;
            Job& job = jobs_[finished_];
            lock.unlock();
            run(job);
            lock.lock();
            ++finished_;
            if (finished_ == jobs_.size()) changed_.notify_all();
        }
    }

    void run(Job& job) {
        for (Completion* wait : job.waits) wait->wait();
        const double start = now() - epoch_;
        try {
            run_body(*job.body, *job.task, job.instance);
        } catch (...) {
            failure_ = std::current_exception();
        }
        times_.push_back({job.instance, job.number, start, now() - epoch_});
        job.completion.set_done();
    }

    void run_body(BoundBody& body, const Task& task, int instance) {
        for (BoundLaunch& launch : body.launches) launch.fill_in(instance, task.iteration);
        const auto run_strip = [&](int strip) { body.run(strip); };
        if (threads_ == 1) {
            for (int strip = task.first_strip; strip < task.end_strip; ++strip) run_strip(strip);
        } else {
            arena_.execute([&] { tbb::parallel_for(task.first_strip, task.end_strip, run_strip); });
        }
    }

    tbb::task_arena arena_;
    PinObserver observer_;
    int threads_;
    std::vector<int> cores_;
    std::vector<BoundBody> bodies_;
    double epoch_ = 0.0;

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Job> jobs_;      // a deque: jobs never move
    std::size_t released_ = 0;  ///< how many of them may run
    std::size_t finished_ = 0;
    std::vector<TaskTime> times_;
    std::exception_ptr failure_;
    bool stopping_ = false;
    std::thread worker_;
};

int lanes_in_use(int wanted) {
    if (wanted == 0) return kernels::widest_pack();
    if (wanted != 1 && wanted != 8 && wanted != 16) {
        throw Misuse("cpu_lanes is " + std::to_string(wanted) +
                     "; kernels take 1, 8 or 16 items per call, or what suits the processor: 0");
    }
    return std::min(wanted, kernels::widest_pack());
}

class CpuDevice final : public Device {
public:
    CpuDevice(int threads, std::vector<int> cores, int lanes, int team) {
        info_.name = "TBB, " + std::to_string(threads) + (threads == 1 ? " thread" : " threads");
        info_.kind = "tbb";
        info_.units = threads;
        info_.lanes = lanes_in_use(lanes);
        info_.cores = std::move(cores);
        info_.team = team;
    }

    const DeviceInfo& info() const override { return info_; }

    std::unique_ptr<DeviceStream> open_stream(std::span<const TaskBody* const> bodies) override {
        return std::make_unique<CpuStream>(info_.units, info_.cores, info_.lanes, bodies);
    }

private:
    DeviceInfo info_;
};

}  // namespace

std::unique_ptr<Device> make_cpu_device(int threads, std::vector<int> cores, int lanes, int team) {
    return std::make_unique<CpuDevice>(threads, std::move(cores), lanes, team);
}

}  // namespace weft
