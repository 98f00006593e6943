#pragma once

#include <map>
#include <set>
#include <span>
#include <vector>

#include "runtime/device.h"
#include "runtime/opencl/api.h"

namespace weft {

/// The completion of a command, whose event the stream keeps.
class OpenClCompletion final : public Completion {
public:
    /// number  among the commands of its queue, in their order
    OpenClCompletion(const cl::Event& event, cl_command_queue queue, long number)
        : event_(event), queue_(queue), number_(number) {}

    void wait() override;
    void when_done(std::function<void()> callback) override;
    const cl::Event& event() const { return event_; }
    cl_command_queue queue() const { return queue_; }
    long number() const { return number_; }

private:
    const cl::Event& event_;
    cl_command_queue queue_;
    long number_;
};

/// For threads that must not end by an exception: the driver's, and those of other devices.
void set_status(cl::UserEvent& event, cl_int status) noexcept;

/// Completions that OpenCL does not know, the host's and other contexts', as events of one context.
class PassedOn {
public:
    explicit PassedOn(cl::Context context) : context_(std::move(context)) {}

    /// Whether it needs to be passed on. own: null for what is not OpenCL's
    bool is_foreign(const OpenClCompletion* own) const;
    const cl::Event& event_of(Completion& completion);
    /// When completions are gone.
    void clear() { events_.clear(); }

private:
    cl::Context context_;
    std::map<const Completion*, cl::UserEvent> events_;
};

/// What the commands of an in-order queue wait for. What an earlier one has waited for, later ones
/// need not name again; of several commands of one queue the last one does.
class QueueWaits {
public:
    QueueWaits() = default;
    explicit QueueWaits(cl_command_queue queue) : queue_(queue) {}

    /// For the next command: the events among `waits` that have not been waited for.
    std::vector<cl::Event> next(std::span<Completion* const> waits, PassedOn& passed_on);
    /// When completions are gone.
    void clear();

private:
    bool is_new(const OpenClCompletion& completion);

    cl_command_queue queue_ = nullptr;
    std::map<cl_command_queue, long> seen_;  ///< the last command of each queue
    std::set<const Completion*> seen_foreign_;
};

}  // namespace weft
