#include "runtime/opencl/completion.h"

namespace weft {

namespace {

void CL_CALLBACK run_callback(cl_event, cl_int, void* data) {
    const std::unique_ptr<std::function<void()>> callback(
        static_cast<std::function<void()>*>(data));
    (*callback)();
}

}  // namespace

void set_status(cl::UserEvent& event, cl_int status) noexcept {
    try {
        event.setStatus(status);
    } catch (const cl::Error&) {
        // The context failed; whoever owns its streams reports that when they finish.
    }
}

void OpenClCompletion::wait() {
    try {
        event_.wait();
    } catch (const cl::Error&) {
        // The command failed; whoever owns its stream reports that when it finishes.
    }
}

void OpenClCompletion::when_done(std::function<void()> callback) {
    auto data = std::make_unique<std::function<void()>>(std::move(callback));
    cl::Event event = event_;
    event.setCallback(CL_COMPLETE, run_callback, data.get());
    static_cast<void>(data.release());  // run_callback owns it now
}

bool PassedOn::is_foreign(const OpenClCompletion* own) const {
    return own == nullptr || own->event().getInfo<CL_EVENT_CONTEXT>() != context_;
}

const cl::Event& PassedOn::event_of(Completion& completion) {
    const auto [known, is_new] = events_.try_emplace(&completion);
    if (is_new) {
        known->second = cl::UserEvent(context_);
        completion.when_done([event = known->second]() mutable { set_status(event, CL_COMPLETE); });
    }
    return known->second;
}

std::vector<cl::Event> QueueWaits::next(std::span<Completion* const> waits, PassedOn& passed_on) {
    std::vector<cl::Event> events;
    std::map<cl_command_queue, const OpenClCompletion*> last;
    for (Completion* wait : waits) {
        const auto* own = dynamic_cast<OpenClCompletion*>(wait);
        if (passed_on.is_foreign(own)) {
            if (seen_foreign_.insert(wait).second) events.push_back(passed_on.event_of(*wait));
        } else if (is_new(*own)) {
            last[own->queue()] = own;
        }
    }
    for (const auto& [queue, completion] : last) events.push_back(completion->event());
    return events;
}

/// To this queue, which has now seen it.
bool QueueWaits::is_new(const OpenClCompletion& completion) {
    if (completion.queue() == queue_) return false;
    long& seen = seen_[completion.queue()];
    if (completion.number() <= seen) return false;
    seen = completion.number();
    return true;
}

void QueueWaits::clear() {
    seen_.clear();
    seen_foreign_.clear();
}

}  // namespace weft
