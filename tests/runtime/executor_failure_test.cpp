// Errors of devices come out of the executor, and leave nothing running or waiting behind.

#include <gtest/gtest.h>

#include <atomic>
#include <deque>
#include <mutex>
#include <thread>

#include "runtime/error.h"
#include "runtime/executor.h"
#include "runtime/tbb/cpu_device.h"
#include "tests/joining_thread.h"
#include "tests/runtime/random_tasks.h"

namespace weft::test {
namespace {

enum class When { kNever, kOpen, kSubmit, kFinish };

/// A command that ends some time after its stream was flushed, so that others really wait for it.
class LateCompletion final : public Completion {
public:
    void wait() override { done_.wait(false); }
    void when_done(std::function<void()> callback) override {
        {
            const std::lock_guard lock(mutex_);
            if (!done_) return callbacks_.push_back(std::move(callback));
        }
        callback();
    }
    void set_done() {
        const std::lock_guard lock(mutex_);
        if (done_) return;
        done_ = true;
        done_.notify_all();
        for (const auto& callback : callbacks_) callback();
    }

private:
    std::mutex mutex_;
    std::atomic<bool> done_ = false;
    std::vector<std::function<void()>> callbacks_;
};

class FailingStream final : public DeviceStream {
public:
    explicit FailingStream(When when) : when_(when) {}
    ~FailingStream() override { stop(); }

    void begin(double) override { completions_.clear(); }
    void rebind() override {}
    Completion* submit(const Submission&) override {
        if (when_ == When::kSubmit && completions_.size() == 5) throw RunError("lost in submit");
        stop();  // it walks through the deque
        return &completions_.emplace_back();
    }
    void flush() override {
        stop();
        running_ = JoiningThread([this, count = completions_.size()] {
            std::this_thread::sleep_for(std::chrono::microseconds(500));
            for (std::size_t i = 0; i < count; ++i) completions_[i].set_done();
        });
    }
    void finish() override {
        stop();
        if (when_ == When::kFinish) throw RunError("lost in finish");
    }
    void times(std::vector<TaskTime>&, std::vector<TimeSpan>&) override {}
    Completion* to_device(BufferStorage&, ElementSpan, std::span<Completion* const>) override {
        return nullptr;
    }
    Completion* to_host(BufferStorage&, ElementSpan, std::span<Completion* const>) override {
        return nullptr;
    }

private:
    void stop() {
        if (running_.joinable()) running_.join();
    }

    When when_;
    std::deque<LateCompletion> completions_;
    JoiningThread running_;
};

class FailingDevice final : public Device {
public:
    explicit FailingDevice(When when) : when_(when) {}
    const DeviceInfo& info() const override { return info_; }
    std::unique_ptr<DeviceStream> open_stream(std::span<const TaskBody* const>) override {
        if (when_ == When::kOpen) throw RunError("lost in open");
        return std::make_unique<FailingStream>(when_);
    }

private:
    When when_;
    DeviceInfo info_;
};

std::string message_of_failure(When when, bool cpu_first) {
    RandomTasks tasks;
    Random random(5);
    tasks.fill(random);
    const Step step = tasks.make_step(random, 40);
    const auto plan = random_plan(step, 2, random);
    FailingDevice failing(when);
    const auto cpu = make_cpu_device(1, {});
    std::vector<Device*> devices{&failing, cpu.get()};
    if (cpu_first) std::swap(devices[0], devices[1]);
    try {
        Executor executor(devices, tasks.bodies());
        executor.run(step, plan, RandomTasks::kInstances);
    } catch (const RunError& error) {
        return error.what();
    }
    return "none";
}

TEST(ExecutorFailure, OfADeviceComesOutAndNobodyHangs) {
    for (const bool cpu_first : {true, false}) {
        for (int repeated = 0; repeated < 20; ++repeated) {
            EXPECT_EQ(message_of_failure(When::kOpen, cpu_first), "lost in open");
            EXPECT_EQ(message_of_failure(When::kSubmit, cpu_first), "lost in submit");
            EXPECT_EQ(message_of_failure(When::kFinish, cpu_first), "lost in finish");
            EXPECT_EQ(message_of_failure(When::kNever, cpu_first), "none");
        }
    }
}

}  // namespace
}  // namespace weft::test
