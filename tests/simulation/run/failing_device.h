#pragma once

#include <memory>

#include "runtime/device.h"

namespace weft::test {

/// When a device fails: in the batch of work behind so many, once it has taken so many of its
/// tasks, which it still does; or, with none (-1), when it has done all of them.
struct Failure {
    int batches = 0;
    int tasks = -1;
};

/// A device that works like the one it wraps until it fails; from then on every call does, as with
/// a GPU that was unplugged.
std::unique_ptr<Device> make_failing_device(std::unique_ptr<Device> inner, Failure failure);

}  // namespace weft::test
