#include "tests/simulation/run/failing_device.h"

#include "runtime/error.h"

namespace weft::test {
namespace {

class FailingStream final : public DeviceStream {
public:
    FailingStream(std::unique_ptr<DeviceStream> inner, int& batches)
        : inner_(std::move(inner)), batches_(batches) {}

    void begin(double epoch) override { inner_->begin(epoch); }
    void rebind() override { inner_->rebind(); }
    Completion* submit(const Submission& submission) override { return inner_->submit(submission); }
    void flush() override { inner_->flush(); }
    void finish() override {
        inner_->finish();
        if (--batches_ < 0) throw RunError("clFinish failed: CL_OUT_OF_RESOURCES (-5)");
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
    std::unique_ptr<DeviceStream> inner_;
    int& batches_;
};

class FailingDevice final : public Device {
public:
    FailingDevice(std::unique_ptr<Device> inner, int batches)
        : inner_(std::move(inner)), batches_(batches) {}

    const DeviceInfo& info() const override { return inner_->info(); }
    std::unique_ptr<DeviceStream> open_stream(std::span<const TaskBody* const> bodies) override {
        return std::make_unique<FailingStream>(inner_->open_stream(bodies), batches_);
    }

private:
    std::unique_ptr<Device> inner_;
    int batches_;
};

}  // namespace

std::unique_ptr<Device> make_failing_device(std::unique_ptr<Device> inner, int batches) {
    return std::make_unique<FailingDevice>(std::move(inner), batches);
}

}  // namespace weft::test
