#include "tests/simulation/run/failing_device.h"

#include <string>

#include "runtime/error.h"

namespace weft::test {
namespace {

class FailingStream final : public DeviceStream {
public:
    FailingStream(std::unique_ptr<DeviceStream> inner, Failure& failure)
        : inner_(std::move(inner)), failure_(failure) {}

    void begin(double epoch) override {
        inner_->begin(epoch);
        submitted_ = 0;
    }
    void rebind() override { inner_->rebind(); }
    Completion* submit(const Submission& submission) override {
        const bool fails = failure_.batches <= 0 && failure_.tasks >= 0;
        if (fails && submitted_ == failure_.tasks) fail("clEnqueueNDRangeKernel");
        ++submitted_;
        return inner_->submit(submission);
    }
    void flush() override { inner_->flush(); }
    void finish() override {
        inner_->finish();
        if (--failure_.batches < 0 && failure_.tasks < 0) fail("clFinish");
    }
    void times(std::vector<TaskTime>& tasks, std::vector<TimeSpan>& copies) override {
        inner_->times(tasks, copies);
    }
    Completion* to_device(BufferStorage& buffer, ElementSpan span,
                          std::span<Completion* const> waits) override {
        return inner_->to_device(buffer, span, waits);
    }
    Completion* to_host(BufferStorage& buffer, ElementSpan span,
                        std::span<Completion* const> waits) override {
        return inner_->to_host(buffer, span, waits);
    }

private:
    [[noreturn]] static void fail(const std::string& call) {
        throw RunError(call + " failed: CL_OUT_OF_RESOURCES (-5)");
    }

    std::unique_ptr<DeviceStream> inner_;
    Failure& failure_;
    int submitted_ = 0;
};

class FailingDevice final : public Device {
public:
    FailingDevice(std::unique_ptr<Device> inner, Failure failure)
        : inner_(std::move(inner)), failure_(failure) {}

    const DeviceInfo& info() const override { return inner_->info(); }
    std::unique_ptr<DeviceStream> open_stream(std::span<const TaskBody* const> bodies) override {
        return std::make_unique<FailingStream>(inner_->open_stream(bodies), failure_);
    }

private:
    std::unique_ptr<Device> inner_;
    Failure failure_;
};

}  // namespace

std::unique_ptr<Device> make_failing_device(std::unique_ptr<Device> inner, Failure failure) {
    return std::make_unique<FailingDevice>(std::move(inner), failure);
}

}  // namespace weft::test
