#pragma once

#include <memory>

#include "runtime/device.h"

namespace weft::test {

/// A device that works like the one it wraps, until it has finished so many batches of work: from
/// then on every call fails, as with a GPU that was unplugged.
std::unique_ptr<Device> make_failing_device(std::unique_ptr<Device> inner, int batches);

}  // namespace weft::test
