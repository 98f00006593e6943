#pragma once

#include <atomic>
#include <deque>
#include <mutex>

#include "runtime/clock.h"
#include "tests/joining_thread.h"
#include "weft/device.h"
#include "weft/error.h"

namespace weft::test {

/// A device of one's own: does everything when it is waited for, by the scalar kernels, in the
/// host's memory. Others' work is waited for in the order of submission.
class OwnDevice final : public Device {
public:
    /// tasks_until_loss  0: it is never lost
    explicit OwnDevice(int tasks_until_loss = 0) : left_(tasks_until_loss) {
        info_.name = "own";
        info_.kind = "test";
    }
    const DeviceInfo& info() const override { return info_; }
    std::unique_ptr<DeviceStream> open_stream(std::span<const TaskBody* const>) override {
        return std::make_unique<Stream>(left_);
    }

private:
    class Done final : public Completion {
    public:
        void wait() override { done_.wait(false); }
        void when_done(std::function<void()> callback) override {
            {
                const std::lock_guard lock(mutex_);
                if (!done_) return callbacks_.push_back(std::move(callback));
            }
            callback();
        }
        void set() {
            const std::lock_guard lock(mutex_);
            done_ = true;
            done_.notify_all();
            for (const auto& callback : callbacks_) callback();
        }

    private:
        std::mutex mutex_;
        std::atomic<bool> done_ = false;
        std::vector<std::function<void()>> callbacks_;
    };

    class Stream final : public DeviceStream {
    public:
        explicit Stream(int& left) : left_(left) {}
        void begin(double epoch) override {
            epoch_ = epoch;
            jobs_.clear();
            times_.clear();
            done_ = 0;
        }
        void rebind() override {}
        Completion* submit(const Submission& s) override {
            stop();  // it walks through the deque
            Job& job = jobs_.emplace_back();
            job.task = s.task;
            job.time = {s.instance, s.number, 0.0, 0.0};
            job.waits.assign(s.waits.begin(), s.waits.end());
            if (left_ > 0 && --left_ == 0) throw RunError("own: unplugged");
            return &job.completion;
        }
        /// A thread for all there is so far, since other devices may wait for it.
        void flush() override {
            stop();
            worker_ = JoiningThread([this, end = jobs_.size()] {
                for (; done_ < end; ++done_) run(jobs_[done_]);
            });
        }
        void finish() override {
            flush();
            stop();
        }
        void times(std::vector<TaskTime>& tasks, std::vector<TimeSpan>&) override {
            tasks.insert(tasks.end(), times_.begin(), times_.end());
        }
        Completion* to_device(BufferStorage&, ElementSpan, std::span<Completion* const>) override {
            return nullptr;
        }
        Completion* to_host(BufferStorage&, ElementSpan, std::span<Completion* const>) override {
            return nullptr;
        }

    private:
        struct Job {
            const Task* task = nullptr;
            TaskTime time;
            std::vector<Completion*> waits;
            Done completion;
        };
        void stop() {
            if (worker_.joinable()) worker_.join();
        }
        void run(Job& job) {
            for (Completion* wait : job.waits) wait->wait();
            job.time.start = now() - epoch_;
            for (int strip = job.task->first_strip; strip < job.task->end_strip; ++strip) {
                run_on_host(*job.task->body, strip, job.time.instance, job.task->iteration);
            }
            job.time.end = now() - epoch_;
            times_.push_back(job.time);
            job.completion.set();
        }

        int& left_;
        double epoch_ = 0.0;
        std::deque<Job> jobs_;
        std::size_t done_ = 0;
        std::vector<TaskTime> times_;
        JoiningThread worker_;
    };

    int left_;
    DeviceInfo info_;
};

}  // namespace weft::test
