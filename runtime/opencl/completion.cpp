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

std::vector<cl::Event> events_for(const cl::Context& context, std::span<Completion* const> waits) {
    std::vector<cl::Event> events;
    for (Completion* wait : waits) {
        if (auto* own = dynamic_cast<OpenClCompletion*>(wait);
            own != nullptr && own->event().getInfo<CL_EVENT_CONTEXT>() == context) {
            events.push_back(own->event());
            continue;
        }
        cl::UserEvent passed_on(context);
        wait->when_done([passed_on]() mutable { set_status(passed_on, CL_COMPLETE); });
        events.push_back(passed_on);
    }
    return events;
}

}  // namespace weft
