#pragma once

#include "runtime/device.h"
#include "runtime/opencl/api.h"

namespace weft {

/// The completion of a command, whose event the stream keeps.
class OpenClCompletion final : public Completion {
public:
    explicit OpenClCompletion(const cl::Event& event) : event_(event) {}

    void wait() override;
    void when_done(std::function<void()> callback) override;
    const cl::Event& event() const { return event_; }

private:
    const cl::Event& event_;
};

/// For threads that must not end by an exception: the driver's, and those of other devices.
void set_status(cl::UserEvent& event, cl_int status) noexcept;

/// An event of `context` that is done when all of `waits` are. Those of the same context are used
/// as they are; others, and the host's, are passed on through user events.
std::vector<cl::Event> events_for(const cl::Context& context, std::span<Completion* const> waits);

}  // namespace weft
